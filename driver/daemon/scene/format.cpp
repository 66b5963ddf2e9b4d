// SPDX-License-Identifier: MIT
#include "scene/format.hpp"

namespace hapticd::scene {

using namespace document;
namespace {

constexpr Range kMeters{-1e6, 1e6, "m"};
constexpr Range kVersion{1, 1};

constexpr std::string_view kPaces[] = {"clock", "device"};
constexpr std::string_view kInstructions[] = {"auto", "portable"};
constexpr std::string_view kClientFrames[] = {"world", "device"};
constexpr std::string_view kEstimators[] = {"window", "butterworth", "foaw", "least_squares", "kalman"};

constexpr Key kPoseKeys[] = {
    vector3<&Pose::position>("position", kMeters, "[0, 0, 0]", "Origin of the frame in its parent."),
    quaternion<&Pose::orientation>("orientation", "[1, 0, 0, 0]", "Orientation as a unit quaternion w, x, y, z."),
};
constexpr Table kPose{kPoseKeys};

constexpr Key kVelocityKeys[] = {
    choice<&Velocity::estimator>(
        "estimator", kEstimators, "window",
        "Filter that estimates the probe's velocity; it runs only if something in the scene uses velocity."),
    real<&Velocity::parameter>(
        "parameter", {1e-9, 1e9}, "3",
        "Samples (window, foaw, least_squares), cut-off in Hz (butterworth) or process noise (kalman)."),
};
constexpr Table kVelocity{kVelocityKeys};

constexpr Key kServoKeys[] = {
    real<&Servo::rate>("rate", {10, 20000, "Hz"}, "1000", "Ticks per second."),
    real<&Servo::activation_radius>("activation_radius", {1e-6, 1e3, "m"}, "0.1",
                                    "Surfaces nearer to the probe than this are traced."),
    real<&Servo::hysteresis>("hysteresis", {0, 1e3, "m"}, "0.05",
                             "A traced surface is dropped when it is farther than activation_radius plus this."),
    vector3<&Servo::gravity>("gravity", {-1000, 1000, "m/s^2"}, "[0, -9.81, 0]",
                             "Gravity in the world frame (y is up)."),
    choice<&Servo::pace>(
        "pace", kPaces, "clock",
        "What starts a tick: clock, or device (each sample of the first arm that can drive the loop)."),
    object<&Servo::velocity>("velocity", kVelocity, "The velocity estimator."),
    real<&Servo::spin_us>("spin_us", {0, 1000, "us"}, nullptr,
                          "Busy wait before each deadline; default: chosen for the machine."),
    choice<&Servo::instructions>(
        "instructions", kInstructions, "auto",
        "Processor instructions of the inner loops. auto: the fastest that this processor has; "
        "portable: those of every processor, so that results have the same bits everywhere."),
    real<&Servo::budget_us>("budget_us", {0, 1e6, "us"}, "0",
                            "CPU time per tick for all shapes together; 0: four fifths of the period."),
};
constexpr Elsewhere kBesideServo[] = {{&kDeviceTable, "the device file"},
                                      {&kDaemonTable, "the daemon file"},
                                      {&kSceneTable, "the scene itself, outside of servo"}};
constexpr Table kServo{kServoKeys, kBesideServo};

constexpr Key kModelKeys[] = {
    required(name<&ModelText::name>("name", "Name of the model; unique in a scene.")),
    required(name<&ModelText::plugin>("plugin", "Shape plugin; `hapticd plugin list` names them.")),
    object<&ModelText::pose>("pose", kPose, "Pose of the model in the world at the start."),
    any<&ModelText::parameters>("parameters", "a mapping of the plugin's parameters",
                                "Parameters of the plugin; `hapticd plugin info NAME` documents them."),
    any<&ModelText::motion>("motion", "one of static, kinematic, dynamic",
                            "How the model moves: static, kinematic (along `path`) or dynamic (by its plugin)."),
    any<&ModelText::path>("path", "the path of a file",
                          "CSV file t,x,y,z,qw,qx,qy,qz of a kinematic model; poses between rows are interpolated. "
                          "Without a path, the model rests at its pose until a program leads it."),
    boolean<&ModelText::enabled>(
        "enabled", "true",
        "false: the model is neither felt nor traced, and costs no time in a tick, until it is "
        "enabled: hapticd ctl enable NAME."),
};

constexpr Key kAdmittanceKeys[] = {
    real<&Admittance::mass>("mass", {1e-3, 1000, "kg"}, "1", "Virtual mass that measured forces move."),
    real<&Admittance::damping>("damping", {0, 1e4, "N s/m"}, "10", "Virtual damping."),
};
constexpr Table kAdmittance{kAdmittanceKeys};

constexpr Key kDeviceReferenceKeys[] = {
    required(file<&DeviceReference::file>("file", "Device file.")),
    name<&DeviceReference::name>("name",
                                 "Name in this scene instead of the device file's name; if two arms use the same "
                                 "file, they need different names."),
    object<&DeviceReference::mount>("mount", kPose, "Pose of the device in the world, instead of the device file's."),
    object<&DeviceReference::admittance>("admittance", kAdmittance,
                                         "Compliance control in this scene, instead of the device file's."),
    any<&DeviceReference::hand>("hand", "a mapping of the hand's parameters",
                                "Settings of the simulated hand that replace the device file's."),
};

constexpr Key kClientsKeys[] = {
    required(
        choice<&Clients::mode>("mode", kClientModes, nullptr,
                               "off: programs may not push; add: forces of programs are added to the forces of the "
                               "models; instead: the models fade out while a program pushes.")),
    real<&Clients::max_force>("max_force", {0, 1000, "N"}, "0",
                              "Largest force of one program; 0: only the device's limit counts."),
    boolean<&Clients::exclusive>("exclusive", "false",
                                 "true: only one program may push on an arm; a second is refused."),
    real<&Clients::answer_time>(
        "answer_time", {0, 200e-6, "s"}, "0",
        "How long after the start of a tick the servo waits for programs that answered the last ticks, "
        "so that their answers count in the same tick; 0: it does not wait."),
    boolean<&Clients::push>("push", "true", "false: programs may read the state of the arms, but may not push."),
    vector3<&Clients::origin>("origin", kMeters, "[0, 0, 0]",
                              "Origin of the coordinates of OpenHaptics programs, in the axes of `frame`."),
    choice<&Clients::frame>(
        "frame", kClientFrames, "world",
        "Frame of the coordinates of OpenHaptics programs: world, or device (the mount of the arm)."),
};

constexpr Key kSceneKeys[] = {
    required(integer<&SceneText::version>("hapticd", kVersion, nullptr, "Version of the format.")),
    object<&SceneText::servo>("servo", kServo, "Rate and settings of the servo loop."),
    any<&SceneText::device>("device", "the path of a device file",
                            "Device file; if the scene names no device, the simulated Premium 1.5 is used."),
    any<&SceneText::devices>("devices", "a list of device files", "Several device files, each with its own probe."),
    any<&SceneText::hand>("hand", "a mapping of the hand's parameters",
                          "Settings of the simulated hand that replace the device file's."),
    any<&SceneText::clients>("clients", "off, add, instead or a mapping with mode",
                             "Whether programs may push on the arms; default: off."),
    required(list<&SceneText::models>("models", kModelTable, {0, kMaxModels}, "The models of the scene.")),
};

constexpr std::string_view kEnableModes[] = {"hold", "toggle"};
constexpr Key kEnableKeys[] = {
    required(
        integer<&Enable::button>("button", {0, 31}, nullptr,
                                 "Button of the device, counted from 0 (`button: 1` of the wire format is 0 here).")),
    choice<&Enable::mode>(
        "mode", kEnableModes, "hold",
        "hold: forces only while the button is down (dead-man switch); toggle: each press turns forces on or off."),
};
constexpr Table kEnable{kEnableKeys};

constexpr Key kMotorKeys[] = {
    real<&Motor::ratio>("ratio", {1e-3, 1e4}, "1", "Ratio of the torque at the joint to the torque at the motor."),
    required(real<&Motor::torque_constant>("torque_constant", {1e-6, 1e3, "N m/A"}, nullptr, "Torque constant.")),
    required(real<&Motor::resistance>("resistance", {1e-6, 1e6, "ohm"}, nullptr, "Resistance at 25 degC.")),
    real<&Motor::winding_housing>("winding_housing", {1e-3, 1e3, "K/W"}, "1",
                                  "Thermal resistance from winding to housing."),
    real<&Motor::housing_air>("housing_air", {1e-3, 1e3, "K/W"}, "10", "Thermal resistance from housing to air."),
    real<&Motor::winding_time>("winding_time", {0.5, 1e5, "s"}, "10", "Thermal time constant of the winding."),
    real<&Motor::housing_time>("housing_time", {0.5, 1e6, "s"}, "600", "Thermal time constant of the motor."),
    real<&Motor::max_temperature>("max_temperature", {30, 400, "degC"}, "100", "Highest temperature of the winding."),
    real<&Motor::ambient>("ambient", {-50, 100, "degC"}, "25", "Temperature of the air."),
};
constexpr Table kMotor{kMotorKeys};

constexpr Key kLimitKeys[] = {
    real<&Limits::force>("force", {0, 1000, "N"}, nullptr,
                         "Largest force on the hand, above 0; default: the device's own maximum."),
    real<&Limits::torque>("torque", {0, 1000, "N m"}, "0", "Largest torque on the hand; 0: only the motors limit it."),
    real<&Limits::slew>("slew", {0, 1e6, "N/s"}, "2000", "Fastest growth of the force; 0: no limit."),
    real<&Limits::torque_slew>("torque_slew", {0, 1e6, "N m/s"}, "200", "Fastest growth of the torque; 0: no limit."),
    real<&Limits::power>("power", {0, 1e4, "W"}, "0", "Largest power that the arm gives to the hand; 0: no limit."),
    real<&Limits::impulse>(
        "impulse", {0, 100, "N s"}, "0",
        "Largest impulse within any 0.1 s; a constant force is limited to five times this number, in N; 0: no limit."),
    real<&Limits::velocity>(
        "velocity", {0, 100, "m/s"}, nullptr,
        "Largest speed of the tip; a faster tip latches a fault; 0: no limit; default: 5 m/s for real "
        "hardware, no limit for simulated arms."),
    real<&Limits::workspace>("workspace", {0, 100, "m"}, "0",
                             "Forces fade outside this radius about the device's origin; 0: no limit."),
    real<&Limits::weight>("weight", {0, 1000, "N"}, nullptr,
                          "Largest force at the tip that carries the arm's own weight; 0: the weight is not carried; "
                          "default: the same as `force`."),
    real<&Limits::ramp_in>("ramp_in", {0, 10, "s"}, "0.25",
                           "Time from zero to full force at the start and after a fault."),
    real<&Limits::ramp_out>("ramp_out", {0, 0.02, "s"}, "0.02",
                            "Time from full force to zero at a planned end; after a fault it is at most 2 ms."),
    boolean<&Limits::passivity>("passivity", nullptr,
                                "Passivity observer and controller; default: on for arms never tried on hardware."),
    object<&Limits::enable>("enable", kEnable, "A button of the device that enables the forces."),
    list<&Limits::motors>("motors", kMotor, {0, 16}, "Motors in the order of the joints, for the model of their heat."),
};
constexpr Elsewhere kBesideLimits[] = {{&kSceneTable, "the scene file"}, {&kDaemonTable, "the daemon file"}};
constexpr Table kLimits{kLimitKeys, kBesideLimits};

constexpr Key kHdKeys[] = {
    name<&HdText::model>("model", "Answer to HD_DEVICE_MODEL_TYPE; some programs accept only certain names."),
    name<&HdText::vendor>("vendor", "Answer to HD_DEVICE_VENDOR."),
    name<&HdText::serial>("serial", "Answer to HD_DEVICE_SERIAL_NUMBER."),
    any<&HdText::joints>("joints", "up to 6 lists [joint, sign, offset]",
                         "Joints in OpenHaptics's order: turret, thigh, shin and the three of the gimbal. Each has the "
                         "number of the device's joint (from 0), the sign (1 or -1) and the offset in rad."),
    any<&HdText::buttons>("buttons", "a list of buttons",
                          "Numbers of the device's buttons (from 0), in the order of OpenHaptics's buttons."),
};
constexpr Table kHd{kHdKeys};

constexpr Key kDeviceKeys[] = {
    required(integer<&DeviceText::version>("hapticd-device", kVersion, nullptr, "Version of the format.")),
    required(name<&DeviceText::module>("module", "Device module; `hapticd device list` names them.")),
    name<&DeviceText::name>("name", "Name of the device; default: the file's name."),
    object<&DeviceText::mount>("mount", kPose, "Pose of the device in the world."),
    object<&DeviceText::limits>("limits", kLimits, "Limits of what is sent to the motors; no plugin can exceed them."),
    object<&DeviceText::admittance>("admittance", kAdmittance,
                                    "Compliance control, for arms that measure joint torques."),
    any<&DeviceText::parameters>("parameters", "a mapping of the module's parameters", "Parameters of the module."),
    any<&DeviceText::hand>("hand", "a mapping of the hand's parameters",
                           "The simulated hand: the module's parameters that begin with `hand.`."),
    object<&DeviceText::hd>("hd", kHd, "How OpenHaptics programs see the arm; default: the module's own description."),
};

constexpr Key kDaemonServoKeys[] = {
    integer<&Daemon::cpu>("cpu", {0, 1023}, nullptr, "Processor that the servo thread is pinned to; default: none."),
    integer<&Daemon::priority>("priority", {1, 98}, "80", "SCHED_FIFO priority of the servo thread."),
    real<&Daemon::rate>("rate", {10, 20000, "Hz"}, nullptr, "Servo rate instead of the scene's."),
};
constexpr Elsewhere kBesideDaemonServo[] = {{&kSceneTable, "the scene file"}, {&kDeviceTable, "the device file"}};
constexpr Table kDaemonServo{kDaemonServoKeys, kBesideDaemonServo};

constexpr Key kDaemonLimitKeys[] = {
    real<&Daemon::force>("force", {0.01, 1000, "N"}, nullptr,
                         "Largest force of any device of this machine, whatever its device file allows."),
};
constexpr Elsewhere kBesideDaemonLimits[] = {{&kDeviceTable, "the device file"}, {&kSceneTable, "the scene file"}};
constexpr Table kDaemonLimits{kDaemonLimitKeys, kBesideDaemonLimits};

constexpr Key kDaemonKeys[] = {
    required(integer<&DaemonText::version>("hapticd-daemon", kVersion, nullptr, "Version of the format.")),
    any<&DaemonText::plugin_path>("plugin_path", "a list of folders",
                                  "Folders that are searched first for plugins and device modules."),
    object<&DaemonText::daemon>("servo", kDaemonServo, "The servo thread of this machine."),
    object<&DaemonText::daemon>("limits", kDaemonLimits, "Limits of this machine."),
};

constexpr Format kAllFormats[] = {
    {"hapticd", "scene", "A scene of hapticd: its models and its arms.", &kSceneTable},
    {"hapticd-device", "device", "An arm for hapticd: its module, calibration and limits.", &kDeviceTable},
    {"hapticd-daemon", "daemon", "Settings of hapticd for one machine.", &kDaemonTable},
};

constexpr Elsewhere kBesideModels[] = {{&kSceneTable, "the scene itself, outside of models"}};
constexpr Elsewhere kBesideClients[] = {{&kDeviceTable, "the device file"},
                                        {&kSceneTable, "the scene itself, outside of clients"}};
constexpr Elsewhere kBesideReference[] = {{&kDeviceTable, "the device file"},
                                          {&kSceneTable, "the scene itself, outside of device"}};
constexpr Elsewhere kBesideScene[] = {{&kClientsTable, "the mapping clients"},
                                      {&kModelTable, "a model (an element of the list models)"},
                                      {&kDeviceTable, "the device file"},
                                      {&kDaemonTable, "the daemon file"}};
constexpr Elsewhere kBesideDevice[] = {{&kSceneTable, "the scene file"}, {&kDaemonTable, "the daemon file"}};
constexpr Elsewhere kBesideDaemon[] = {{&kSceneTable, "the scene file"}, {&kDeviceTable, "the device file"}};

}  // namespace

constexpr Table kModelTable{kModelKeys, kBesideModels};
constexpr Table kClientsTable{kClientsKeys, kBesideClients};
constexpr Table kDeviceReferenceTable{kDeviceReferenceKeys, kBesideReference};
constexpr Table kSceneTable{kSceneKeys, kBesideScene};
constexpr Table kDeviceTable{kDeviceKeys, kBesideDevice};
constexpr Table kDaemonTable{kDaemonKeys, kBesideDaemon};
constexpr std::span<const Format> kFormats{kAllFormats};

}  // namespace hapticd::scene
