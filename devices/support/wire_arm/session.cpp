// SPDX-License-Identifier: MIT
#include "wire_arm/session.hpp"

#include <algorithm>
#include <cmath>

namespace hapticd::wire_arm {
namespace {

constexpr double kGap = 5;          ///< [reports] see Session::longGap()
constexpr double kLonger = 1.5;     ///< a gap that is so much longer than those before it is long
constexpr uint64_t kFewBad = 4;     ///< fewer bad reports in Session::kRateWindow do not make an arm too slow
constexpr double kOldReports = 64;  ///< most reports that an arm, a hub or the kernel may keep and send again

double seconds(Nanoseconds from, Nanoseconds to) noexcept {
  return to > from ? static_cast<double>(to - from) * kSecondsPerNanosecond : 0;
}

/// Returns after how many raw units the number of a field begins anew; infinity for floats.
double cycleOf(const codec::Field& field) noexcept {
  if (field.modulo != 0) return static_cast<double>(field.modulo);
  if (field.type == codec::Type::kFloat) return HUGE_VAL;
  const auto [least, most] = codec::rangeOf(field.type, field.bits);
  return most - least + 1;
}

/// Returns whether a number that grows from report to report says that a report is an old one: it is the same as the
/// last one, or less than it by at most `old`. @param cycle after this much the number begins anew
bool isOld(double last, double number, double cycle, double old) noexcept {
  const double behind = last >= number ? last - number : last - number + cycle;
  return behind <= std::min(old, cycle / 4);
}

/// Returns the trouble of an arm whose reports are like this one; kNone if they say nothing.
Trouble troubleOf(codec::Verdict verdict) noexcept {
  switch (verdict) {
    case codec::Verdict::kWrongSize:
      return Trouble::kShort;
    case codec::Verdict::kCorrupt:
      return Trouble::kCorrupt;
    case codec::Verdict::kTorn:
      return Trouble::kTorn;
    default:
      return Trouble::kNone;
  }
}

}  // namespace

const char* describe(Trouble trouble) noexcept {
  switch (trouble) {
    case Trouble::kNone:
      return "healthy";
    case Trouble::kUnplugged:
      return "the device is unplugged; plug it in again";
    case Trouble::kStalled:
      return "an endpoint of the device has stalled; the device is reopened, and if this does not help, unplug it";
    case Trouble::kBusError:
      return "transfers on the bus fail; check the cable, the hub or the rack";
    case Trouble::kFirmware:
      return "the firmware has another version than the device file expects; "
             "load that version, or correct the device file";
    case Trouble::kShort:
      return "reports have a wrong size; the device file does not fit this device";
    case Trouble::kCorrupt:
      return "reports are corrupt; check the cable, and that the device file fits this device";
    case Trouble::kStale:
      return "no new reports come; check power and cable";
    case Trouble::kSlow:
      return "too few reports come per second; check the hub, or correct wire.rate";
    case Trouble::kJump:
      return "an encoder jumped; calibrate again";
    case Trouble::kHardware:
      return "the hardware reports a fault; switch it off and on";
    case Trouble::kAbsent:
      return "no board answers on the bus; switch the rack on, or correct the address in the device file";
    case Trouble::kTorn:
      return "reports are never complete; the board stopped while it wrote one: reset it";
    case Trouble::kReset:
      return "the board restarted and lost its zero; find out why it restarted, then calibrate again";
    case Trouble::kOld:
      return "reports come, but all are old: their counter or clock does not grow; "
             "reset the board, or correct the field {is: counter} or {is: time} in the device file";
  }
  return "unknown trouble";
}

Session::Session(const codec::Wire& wire, const SessionSettings& settings)
    : wire_(wire), settings_(settings), framer_(wire.framing, wire.input.bytes()), clock_tells_(wire.clockTells()) {
  constexpr double kTwoTo32 = 4294967296.0;  // State::sequence has 32 bits
  sequence_cycle_ = kTwoTo32;
  for (const codec::Field& field : wire_.input.fields) {
    if (field.role == codec::Role::kSequence) sequence_cycle_ = std::min(sequence_cycle_, cycleOf(field));
    if (field.role == codec::Role::kTime) clock_cycle_ = cycleOf(field) * field.scale;
    if (field.role == codec::Role::kPosition && field.wraps)
      span_[field.index] = cycleOf(field) * std::abs(field.scale);
  }
}

void Session::attach(Nanoseconds now, const JointArray& zero, bool calibrated) noexcept {
  framer_.reset();
  zero_ = zero;
  calibrated_ = calibrated;
  attached_ = true;
  have_raw_ = false;
  turns_ = {};
  reports_ = 0;
  attached_at_ = sent_;
  good_at_ = now;
  bad_at_ = named_at_ = 0;
  // The arm does not count as healthy yet. It begins with a trouble, which ends after some time of good reports.
  raise(now, sample_.trouble == Trouble::kNone ? Trouble::kStale : sample_.trouble);
}

void Session::lose(Nanoseconds now, Trouble trouble) noexcept {
  attached_ = false;
  raise(now, trouble);
}

void Session::raise(Nanoseconds now, Trouble trouble) noexcept {
  if (trouble != sample_.trouble) named_at_ = trouble == last_bad_ ? bad_at_ : 0;
  sample_.trouble = trouble;
  trouble_at_ = now;
}

bool Session::receive(Nanoseconds now, std::span<const uint8_t> bytes) noexcept {
  if (!wire_.framing.used) return take(now, bytes);
  bool fresh = false;
  const size_t lost = framer_.take(bytes, [&](std::span<const uint8_t> report) { fresh = take(now, report) || fresh; });
  if (lost > 0) reject(now, codec::Verdict::kCorrupt);
  return fresh;
}

void Session::reject(Nanoseconds now, codec::Verdict verdict) noexcept {
  ++bad_reports_;
  bad_at_ = now;
  last_bad_ = troubleOf(verdict);
  if (last_bad_ != Trouble::kNone && last_bad_ == sample_.trouble) named_at_ = now;
}

bool Session::take(Nanoseconds now, std::span<const uint8_t> bytes) noexcept {
  const codec::Verdict verdict = codec::decode(wire_.input, bytes, state_);
  if (verdict == codec::Verdict::kWrongFirmware) {
    reject(now, verdict);
    raise(now, Trouble::kFirmware);
    return true;
  }
  if (verdict == codec::Verdict::kWrongId) return false;  // another kind of report of the same device
  if (verdict != codec::Verdict::kGood) return reject(now, verdict), false;
  if (startedAnew(now)) have_raw_ = false;
  if (have_raw_ && again()) {
    old_at_ = now;
    return false;
  }
  last_sequence_ = state_.sequence, last_clock_ = state_.clock;
  if (!follow(now, state_)) return true;
  arrivals_[reports_++ % kRateWindow] = {now, bad_reports_};
  good_at_ = now;
  if (state_.fault)
    raise(now, Trouble::kHardware);
  else
    recover(now);
  publish(now, state_);
  return true;
}

/// Ends a trouble after some time of good reports. The first report of all need not wait, because nothing was wrong
/// before it.
void Session::recover(Nanoseconds now) noexcept {
  if (sample_.trouble == Trouble::kJump) return;
  if (lostCounts()) return raise(now, Trouble::kJump);
  if (sample_.sequence == 0 || seconds(trouble_at_, now) >= settings_.health.recovery) sample_.trouble = Trouble::kNone;
}

/// Returns whether the arm sent an old report again: its counter or, without a counter, its clock has not advanced. A
/// board that is stuck may send the same report again, or the last ones that it keeps in turn.
bool Session::again() const noexcept {
  if (state_.has_sequence) return isOld(last_sequence_, state_.sequence, sequence_cycle_, kOldReports);
  return state_.has_clock && clock_tells_ && isOld(last_clock_, state_.clock, clock_cycle_, kOldReports / wire_.rate);
}

/// Returns whether the board has restarted since the last report. If so, forgets the positions and the calibration,
/// because the board now counts from another position. Counts that it lost before are lost no more, also if it
/// restarted while it was not attached.
bool Session::startedAnew(Nanoseconds now) noexcept {
  const bool anew = state_.has_starts && sample_.sequence > 0 && state_.starts != last_starts_;
  last_starts_ = state_.starts;
  if (anew) lost_ = {};
  if (!anew || !have_raw_) return false;
  turns_ = {};
  calibrated_ = false;
  raise(now, Trouble::kReset);
  return true;
}

/// Adds full turns to positions that wrap. Returns false if a joint jumped, or if the arm is not trusted again since a
/// jump.
bool Session::follow(Nanoseconds now, const codec::State& state) noexcept {
  const double period = std::max(seconds(good_at_, now), 0.5 / wire_.rate);
  const double most = settings_.health.max_speed * std::max(period, 1 / wire_.rate);
  if (!state.calibrated) zeroless_at_ = now;
  JointArray next{};
  for (size_t i = 0; i < settings_.joints; ++i) {
    next[i] = state.position[i] + turns_[i];
    if (!have_raw_) continue;
    if (span_[i] > 0) {
      const double turns = std::nearbyint((raw_[i] - next[i]) / span_[i]) * span_[i];
      turns_[i] += turns;
      next[i] += turns;
    }
    if (std::abs(next[i] - raw_[i]) <= most) continue;
    if (sample_.trouble != Trouble::kJump) calibrated_ = false;  // encoder counts were lost, so the zero is wrong
    lost_[i] += next[i] - raw_[i];
    raise(now, Trouble::kJump);
  }
  raw_ = next;
  have_raw_ = true;
  if (seconds(zeroless_at_, now) < settings_.health.recovery) lost_ = {};  // it jumps as it finds its zero
  if (sample_.trouble != Trouble::kJump) return true;
  // An arm with absolute encoders, or one that finds its own zero, is trusted again after some time.
  const bool known = settings_.calibration != Calibration::kPose && !lostCounts();
  if (!known || seconds(trouble_at_, now) < settings_.health.recovery) {
    good_at_ = now;
    publish(now, state);
    return false;
  }
  sample_.trouble = Trouble::kNone;
  return true;
}

/// Returns whether an arm that finds its own zero lost counts since then. It does not notice this, and calls itself
/// calibrated all the same, also after it was plugged in again. If it jumped back, only the wire was wrong.
bool Session::lostCounts() const noexcept {
  const double most = settings_.health.max_speed / wire_.rate;
  return settings_.calibration == Calibration::kDevice &&
         std::any_of(lost_.begin(), lost_.end(), [most](double lost) { return std::abs(lost) > most; });
}

void Session::publish(Nanoseconds now, const codec::State& state) noexcept {
  sample_.time = now;
  ++sample_.sequence;
  sample_.buttons = state.buttons;
  sample_.velocity = state.velocity;
  sample_.torque = state.torque;
  for (size_t i = 0; i < settings_.joints; ++i) sample_.position[i] = raw_[i] + zero_[i];
  if (settings_.calibration == Calibration::kNone) calibrated_ = true;
  if (settings_.calibration == Calibration::kDevice) calibrated_ = state.calibrated;
  sample_.calibrated = calibrated_;
}

bool Session::tooSlow(Nanoseconds now) noexcept {
  if (settings_.health.least_rate <= 0 || reports_ <= kRateWindow) return false;
  if (wire_.exchange == codec::Exchange::kPoll) {  // a polled arm sends at most one report per command
    const auto answers = static_cast<double>(reports_ - answered_[sent_ % kRateWindow]);
    return sent_ > attached_at_ + kRateWindow && answers < settings_.health.least_rate * (kRateWindow - 1);
  }
  const Nanoseconds oldest = arrivals_[reports_ % kRateWindow].at;
  return seconds(oldest, now) > static_cast<double>(kRateWindow) / (wire_.rate * settings_.health.least_rate);
}

/// Returns how long [s] new reports are away before an arm is silent and not slow.
double Session::longGap() const noexcept {
  return std::min(kGap / wire_.rate, settings_.health.stale / 2);
}

/// Returns how long [s] new reports of this arm are away before it is silent and not slow. Those of a slow arm are as
/// far from each other all the time.
double Session::longGapHere() const noexcept {
  double usual = 0;
  for (size_t i = 1; i < kRateWindow; ++i)
    usual = std::max(
        usual, seconds(arrivals_[(reports_ + i - 1) % kRateWindow].at, arrivals_[(reports_ + i) % kRateWindow].at));
  return std::max(longGap(), kLonger * usual);
}

/// Returns what comes in place of new reports since the given time. Of several kinds of bad reports, the one that has
/// given the trouble its name keeps it while it comes.
Trouble Session::whatComes(Nanoseconds since) const noexcept {
  if (bad_at_ > since && last_bad_ != Trouble::kNone) {
    const bool comes = named_at_ > since && seconds(named_at_, bad_at_) < settings_.health.stale;
    return comes ? sample_.trouble : last_bad_;
  }
  const double gap = seconds(good_at_, old_at_);  // a report that comes twice is no stream of old ones
  return gap > longGap() ? Trouble::kOld : Trouble::kStale;
}

bool Session::watch(Nanoseconds now) noexcept {
  if (!attached_) return false;
  const Trouble before = sample_.trouble;
  const double gap = seconds(good_at_, now);
  if (gap > settings_.health.stale && before != Trouble::kFirmware) {
    const bool named = before == Trouble::kHardware || before == Trouble::kJump;
    raise(now, named ? before : whatComes(good_at_));
  } else if (tooSlow(now)) {
    const Arrival& oldest = arrivals_[reports_ % kRateWindow];
    const bool slow = gap < longGapHere() && bad_reports_ < oldest.bad + kFewBad;
    const Trouble found = slow ? Trouble::kSlow : whatComes(oldest.at);
    if (before == Trouble::kNone || before == Trouble::kSlow || before == found) raise(now, found);
  }
  return sample_.trouble != before;
}

/// Returns the share of the host's torque that is sent (0 to 1): it ramps up after a trouble is over.
double Session::gain(Nanoseconds now, bool healthy) noexcept {
  if (!healthy) {
    healthy_at_ = 0;
    return 0;
  }
  if (healthy_at_ == 0) healthy_at_ = now;
  return settings_.health.ramp > 0 ? std::min(1.0, seconds(healthy_at_, now) / settings_.health.ramp) : 1;
}

size_t Session::command(Nanoseconds now, const ArmCommand& wanted, std::span<uint8_t> bytes) noexcept {
  const bool fresh = wanted.sequence > 0 && seconds(wanted.time, now) <= settings_.health.host_silent;
  const bool healthy = attached_ && sample_.trouble == Trouble::kNone && sample_.calibrated;
  const double part = gain(now, healthy && fresh);
  codec::Order order;
  order.enable = healthy && fresh && wanted.on;
  order.follow = wanted.follow;
  for (size_t i = 0; i < settings_.joints; ++i) {
    order.torque[i] = part * wanted.torque[i];
    // References start at the present position of the joint, so that the arm's own loop ramps in like a torque.
    order.position[i] = raw_[i] + part * (wanted.position[i] - zero_[i] - raw_[i]);
  }
  order.calibrate = calibrate_;
  answered_[sent_ % kRateWindow] = reports_;
  order.sequence = ++sent_;
  return codec::addEscapes(wire_.framing, bytes, codec::encode(wire_.output, order, bytes));
}

void Session::setZero(const JointArray& zero) noexcept {
  zero_ = zero;
  calibrated_ = sample_.calibrated = true;
  for (size_t i = 0; i < settings_.joints; ++i) sample_.position[i] = raw_[i] + zero_[i];
  if (sample_.trouble == Trouble::kJump) sample_.trouble = Trouble::kStale;
}

}  // namespace hapticd::wire_arm
