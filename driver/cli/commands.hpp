// SPDX-License-Identifier: MIT
/// Every subcommand of `hapticd`, in the order of `--help`. A new command needs a file of its own and a line in each
/// list.
#pragma once
#include "cli/support/command.hpp"

namespace hapticd::cli {

using AddCommand = void(const Command& app, int& exit_code);

// clang-format off: one command per line
AddCommand addCheck, addClient, addCompletion, addCtl, addDevice, addDeviceCalibrate, addDeviceCheck, addDeviceControls, addDeviceDecode,
    addDeviceKinematics, addDeviceList, addDeviceNew, addDeviceRecord, addDeviceTwin, addDoctor, addExplain, addExport, addImport, addManual, addPart,
    addPlot, addPlugin, addPluginCheck, addPluginNew, addReplay, addRun, addTop, addTrace, addTune, addView;

/// A subcommand ("device calibrate") must come after its parent ("device"), because it looks the parent up.
constexpr AddCommand* kCommands[] = {
    addCheck,
    addClient,
    addCompletion,
    addCtl,
    addDevice,
    addDeviceCalibrate,
    addDeviceCheck,
    addDeviceControls,
    addDeviceDecode,
    addDeviceKinematics,
    addDeviceList,
    addDeviceNew,
    addDeviceRecord,
    addDeviceTwin,
    addDoctor,
    addExplain,
    addExport,
    addImport,
    addManual,
    addPart,
    addPlot,
    addPlugin,
    addPluginCheck,
    addPluginNew,
    addReplay,
    addRun,
    addTop,
    addTrace,
    addTune,
    addView,
};
// clang-format on

}  // namespace hapticd::cli
