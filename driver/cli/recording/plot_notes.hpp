// SPDX-License-Identifier: MIT
/// What a picture of a recording says beside its ticks: models, limits, marks, and how joints moved.
#pragma once
#include <cstdint>
#include <vector>

#include "record/picture.hpp"
#include "record/recording.hpp"

namespace hapticd::cli {

/// [main] Returns models and limits of the run, and whether it ran in virtual time; empty if the description of the run
/// cannot be read. Gives the samples the models of the notes, and the depths of their arm.
/// @param ticks the stream `ticks`; @param rows those of the samples
record::RunNotes notesOf(const record::Recording& recording, const record::RecordedStream& ticks,
                         const std::vector<uint64_t>& rows, uint32_t arm, std::vector<record::Sample>& samples,
                         bool& virtual_time);

}  // namespace hapticd::cli
