// SPDX-License-Identifier: MIT
/** Says where an arm cannot go farther: a tip that does not follow the mouse must have a reason that a person can see. */

const kAt = 1e-4; // rad or m: a joint nearer than this to the end of its range is there, as in the report of a run

/** Returns the joints [numbers from 1] that are at the end of their range. A joint without a range has no end. */
export function jointsAtEnd(info, joints) {
  const {joint_count: count = 0, position_min: low = [], position_max: high = []} = info ?? {};
  return Array.from({length: count}, (_, i) => i)
    .filter((i) => high[i] - low[i] > 2 * kAt && (joints[i] <= low[i] + kAt || joints[i] >= high[i] - kAt))
    .map((i) => i + 1);
}

/** Returns a sentence about the arms that are at an end, or ''. */
export function endText(arms) {
  const texts = arms.filter((arm) => arm.now?.valid).map((arm) => {
    const ends = jointsAtEnd(arm.info, arm.now.joints);
    if (ends.length === 0) return '';
    const who = arms.length > 1 ? `${arm.name}: ` : '';
    const joints = ends.length > 1 ? `joints ${ends.join(' and ')} are` : `joint ${ends[0]} is`;
    return `${who}${joints} at the end of the range, so the arm cannot go farther`;
  });
  return texts.filter((text) => text !== '').join('; ');
}
