// SPDX-License-Identifier: MIT
#include "watch/crash.hpp"

#include <dlfcn.h>
#include <fcntl.h>
#include <time.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <iterator>

#include "base/call_name.hpp"
#include "base/fatal_signals_posix.hpp"
#include "base/os.hpp"
#include "base/owner_file.hpp"
#include "watch/ended.hpp"
#include "watch/process_end.hpp"
#include "watch/quarantine.hpp"
#include "watch/signal_words.hpp"

namespace hapticd::watch {

namespace {

/// Everything that the handler needs, prepared while memory can still be allocated.
struct Prepared {
  std::atomic<Watched*> servo{nullptr};
  std::atomic<int> process{0};       ///< a fork of this process is not its business
  std::atomic<bool> leaving{false};  ///< the process ends in order, so its exit is nobody's fault
  char dir[kLongestPath] = "";       // "": nothing is written
  /// The C library's last words, if it keeps them: a length, and then the text.
  const char* const* last_words = nullptr;
};
Prepared prepared;
std::atomic<int> dying{0};  ///< the thread that ends the process

/// What a crash in the daemon's own code says about code that does not ship with it.
enum class Suspicion {
  kNone,   ///< nothing: the signal came from outside, or the culprit is known
  kCrash,  ///< such code may have caused the crash
  kTorn    ///< memory was overwritten or freed twice before the crash, most likely by such code
};

/// Belongs to that thread alone. The reason and the culprit are fixed at the first step, because later steps see a
/// process that is falling apart.
struct Death {
  std::atomic<size_t> step{0};  ///< the next of kSteps
  bool motors_off = false;
  const Owner* culprit = nullptr;
  bool called = false;         ///< the thread that ends the process did so
  const char* call = nullptr;  ///< name of its function; nullptr: a step
  Suspicion suspicion = Suspicion::kNone;
  int not_remembered = 0;  ///< errno
  Line reason, black_box;  ///< name of its file, once that is written
};
Death death;

bool sentByOther(const siginfo_t& info) noexcept {
  return info.si_code <= 0 && info.si_code != SI_TIMER && info.si_pid != 0 && info.si_pid != getpid();
}

/// Whose code raised a signal. A signal from another process, or one sent to the process instead of a thread, has no
/// known culprit: no name is better than a wrong one.
const Owner* culpritOf(int signal, const siginfo_t& info, const void* context) noexcept {
  const bool own_fault = wordsOfCrash(signal) != nullptr && info.si_code > 0;
  const bool raised = info.si_code == SI_TKILL && info.si_pid == getpid();
  if (!own_fault && !raised) return nullptr;
  if (const Owner* called = calledHere()) return called;
  return isWorker() ? nullptr : ownerInterrupted(context);  // a thread that a plugin or module started itself
}

/// True if the allocator found its own records overwritten: whoever did that has returned long ago. Code that does not
/// ship with the daemon is the likeliest cause.
bool allocatorAborted() noexcept {
  constexpr const char* kItsWords[] = {"free", "alloc", "corrupt", "chunk"};
  const char* said = prepared.last_words != nullptr ? *prepared.last_words : nullptr;
  if (said == nullptr) return false;
  return std::any_of(std::begin(kItsWords), std::end(kItsWords),
                     [said](const char* word) { return std::strstr(said + sizeof(unsigned), word) != nullptr; });
}

bool isForeign(const Owner& owner) noexcept {
  for (size_t i = 0; const Owner* foreign = foreignOwner(i); ++i)
    if (foreign->module == owner.module) return true;
  return false;
}

/// nullptr: nothing is watched, or this process is a fork of the one that is.
Watched* watchedHere() noexcept {
  return prepared.process.load() == getpid() ? prepared.servo.load() : nullptr;
}

/// Ends as if nobody had handled the signal.
void dieBySystem(int signal) noexcept {
  std::signal(signal, SIG_DFL);
  std::raise(signal);
}

[[noreturn]] void die(const char* reason, const Owner* culprit, Suspicion suspicion) noexcept;

void onFatal(int signal, siginfo_t* info, void* context) {
  Watched* servo = watchedHere();
  const bool other = wordsOfCrash(signal) == nullptr && sentByOther(*info);
  if ((servo == nullptr && prepared.servo.load() != nullptr) || (other && servo != nullptr && !servo->drives()))
    return dieBySystem(signal);
  if (servo != nullptr && other) {
    servo->stop();
    Line()
        .add("\nwarning: the run ends by ")
        .add(words(signal).text())
        .add(", which another process sent\n")
        .write(STDERR_FILENO);
    return;
  }
  const Owner* culprit = culpritOf(signal, *info, context);
  const bool own = info->si_code > 0 || (info->si_code == SI_TKILL && info->si_pid == getpid());
  const bool torn = signal == SIGABRT && allocatorAborted();
  // Shipped code may free what was torn before, so code that does not ship is the likelier cause.
  if (torn && culprit != nullptr && foreignOwner(0) != nullptr && !isForeign(*culprit)) culprit = nullptr;
  die(words(signal).text(), culprit,
      culprit != nullptr || !own ? Suspicion::kNone
      : torn                     ? Suspicion::kTorn
                                 : Suspicion::kCrash);
}

Line& addOwner(Line& line, const Owner& owner) noexcept {
  line.add(owner.device ? "device module '" : "plugin '").add(owner.module.c_str());
  return line.add(owner.device ? "' of device '" : "' of model '").add(owner.name.c_str()).add("'");
}

/// " in its activate()", or " in a step", which is what a module is called for if nothing is named.
Line& addCall(Line& line, const Owner& owner, const char* name) noexcept {
  if (name != nullptr) return line.add(" in its ").add(name).add("()");
  return line.add(owner.device ? " in one of its calls" : " in a step");
}

/// Ctrl-C, SIGTERM and the like. If a module sent one to its own process, no person wished it.
void onStop(int signal, siginfo_t* info, void* context) {
  const bool own = info->si_code <= 0 && info->si_code != SI_TIMER && info->si_pid == getpid();
  if (own && watchedHere() != nullptr) dieOf(words(signal).text(), culpritOf(signal, *info, context));
  if (void (*former)(int) = os::formerStop(signal)) return former(signal);
  const Owner* keeps = watchedHere() != nullptr ? calledHere() : nullptr;
  if (keeps != nullptr) {
    Line line;
    addOwner(line.add("\nwarning: ended by ").add(words(signal).text()).add(" while "), *keeps).add(" was");
    addCall(line, *keeps, callNameHere()).add("\n");
    line.write(STDERR_FILENO);
  }
  dieBySystem(signal);
}

/// A plugin or library that called exit(): static objects still exist, and other threads still run.
void dieOfExit(const char* what) noexcept {
  if (prepared.leaving.load() || watchedHere() == nullptr) return;
  const Owner* culprit = calledHere();
  if (culprit == nullptr && !isWorker()) culprit = ownerOnStack(__builtin_frame_address(0));
  dieOf(what, culprit);
}

void onExit() {
  dieOfExit("a call of exit()");
}

void saveBlackBox(const Watched& servo, const char* file) noexcept {
  const int fd = open(file, O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0640);
  if (fd < 0) return;
  const auto* bytes = static_cast<const char*>(servo.blackBox());
  for (size_t done = 0; done < servo.blackBoxBytes();) {
    const ssize_t written = write(fd, bytes + done, servo.blackBoxBytes() - done);
    if (written <= 0) break;
    done += static_cast<size_t>(written);
  }
  close(fd);
}

/// What an I/O thread still has to send would be lost with the process, so it gets a moment.
void awaitCut(const Watched& servo) noexcept {
  constexpr timespec kPause{0, 500'000};
  constexpr int kPauses = 100;
  for (int i = 0; i < kPauses && !servo.cutLeft(); ++i) nanosleep(&kPause, nullptr);
}

void cutMotors(Watched& servo) noexcept {
  if (!servo.drives()) return;
  servo.cut(0);
  awaitCut(servo);
  death.motors_off = true;
}

void writeBlackBox(Watched& servo) noexcept {
  if (prepared.dir[0] == '\0' || servo.blackBox() == nullptr) return;
  Line file;
  file.add(prepared.dir).add("/black-box-");
  file.addName(death.culprit != nullptr ? death.culprit->module.c_str() : "hapticd").add(".flight");
  saveBlackBox(servo, file.text());
  death.black_box = file;
}

/// Who ended the process: the culprit, or, if memory was torn, all modules that do not ship with us; nullptr: there are
/// no more.
const Owner* leftOut(size_t number) noexcept {
  if (death.suspicion == Suspicion::kTorn) return foreignOwner(number);
  return number == 0 ? death.culprit : nullptr;
}

/// A device module cannot be left out of the next start, so it is only named.
bool mayBeLeftOut() noexcept {
  const Owner* first = leftOut(0);
  return first != nullptr && !first->device && prepared.dir[0] != '\0';
}

void remember(Watched&) noexcept {
  if (!mayBeLeftOut()) return;
  errno = 0;
  const int fd = open(Line().add(prepared.dir).add("/").add(kQuarantineFile).text(),
                      O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0640);
  bool written = fd >= 0;
  for (size_t i = 0; const Owner* owner = leftOut(i); ++i) {
    Line line;
    const char* file = fileOf(owner);
    line.add(owner->module.c_str())
        .add("\t")
        .add(death.reason.text())
        .add(*file != '\0' ? "\t" : "")
        .add(file)
        .add("\n");
    written = written && line.write(fd);
  }
  written = written && fsync(fd) == 0;
  if (!written) death.not_remembered = errno != 0 ? errno : ENOSPC;
  if (fd >= 0) close(fd);
}

void tellCulprit(Line& line) noexcept {
  line.add("\nerror: ");
  const Owner* culprit = death.culprit;
  const char* place = culprit != nullptr ? placeOf(culprit) : "";
  if (*place != '\0') line.add(place).add(": ");
  if (culprit != nullptr)
    addOwner(line, *culprit);
  else
    line.add("the daemon itself");
  line.add(" was ended by ").add(death.reason.text());
  if (death.called) addCall(line.add(","), *culprit, death.call);
  if (death.suspicion == Suspicion::kTorn) line.add(": memory was overwritten, or freed twice");
  line.add("\n  ");
}

/// "plugin 'torus' of model 'ring', plugin ...": modules that do not ship with hapticd. False if there are none.
bool addForeign(Line& line) noexcept {
  size_t count = 0;
  for (; const Owner* owner = foreignOwner(count); ++count) addOwner(line.add(count > 0 ? ", " : ""), *owner);
  return count > 0;
}

/// What to try before reporting the daemon itself.
void tellForeign(Line& line) noexcept {
  if (death.suspicion == Suspicion::kNone || foreignOwner(0) == nullptr) return;
  addForeign(line.add("what does not ship with hapticd is the likeliest cause: "));
  line.add("\n  ");
}

void tellCure(Line& line, bool drives) noexcept {
  if (mayBeLeftOut() && death.not_remembered == 0) {
    line.add(
            "the next start leaves its models out\n  fix: look at the plugin (hapticd plugin check FILE.so), then: "
            "hapticd plugin clear ")
        .add(leftOut(0)->module.c_str())
        .add("\n");
  } else if (mayBeLeftOut()) {
    const char* why = strerrordesc_np(death.not_remembered);
    line.add("it could not be put in quarantine, so the next start loads it again: ").add(prepared.dir);
    line.add(": ").add(why != nullptr ? why : "not written").add("\n  fix: take it out of the scene\n");
  } else if (death.culprit != nullptr && !death.culprit->device) {
    line.add(drives ? "the run" : "the command")
        .add(" has ended\n  fix: repair the plugin; hapticd plugin check FILE.so looks for the cause\n");
  } else if (death.suspicion != Suspicion::kNone && foreignOwner(0) != nullptr) {
    line.add("it has ended\n  fix: try that first (hapticd plugin check FILE.so); if it passes, report this with the ")
        .add("output of: hapticd doctor --json\n");
  } else if (!drives) {
    line.add("the command has ended\n  fix: report it with the output of: hapticd doctor --json\n");
  } else {
    line.add("the run has ended\n  fix: report it with the black box and the output of: hapticd doctor --json\n");
  }
}

void tell(Watched& servo) noexcept {
  Line line;
  tellCulprit(line);
  if (servo.drives())
    line.add(death.motors_off ? "the motors were switched off first" : "to switch the motors off crashed as well");
  if (*death.black_box.text() != '\0') line.add("; the last seconds are in ").add(death.black_box.text());
  if (servo.drives()) line.add("\n  ");
  tellForeign(line);
  tellCure(line, servo.drives());
  line.write(STDERR_FILENO);
}

constexpr void (*kSteps[])(Watched&) noexcept = {&cutMotors, &remember, &writeBlackBox, &tell};

/// For a thread that finds another one ending the process: that one does it, unless it is stuck itself.
[[noreturn]] void awaitEnd() noexcept {
  constexpr timespec kPatience{5, 0};
  nanosleep(&kPatience, nullptr);
  endProcess(1);
}

void die(const char* reason, const Owner* culprit, Suspicion suspicion) noexcept {
  Watched* servo = prepared.servo.load();
  if (servo == nullptr) endProcess(1);
  int nobody = 0;
  const int self = os::threadId();
  if (!dying.compare_exchange_strong(nobody, self) && nobody != self) awaitEnd();
  // A step that crashes itself (the device's cut, on a heap just torn) brings this thread here again: on with the next.
  if (nobody == 0) {
    death.reason.add(reason);
    death.culprit = culprit;
    death.suspicion = suspicion;
    death.called = culprit != nullptr && culprit == calledHere();
    death.call = callNameHere();
  }
  for (size_t step = death.step++; step < std::size(kSteps); step = death.step++) kSteps[step](*servo);
  endProcess(1);
}

}  // namespace

void guardAgainstCrash(Watched& servo, const std::filesystem::path& dir) {
  static const bool at_exit = std::atexit(&onExit) == 0 && std::at_quick_exit(&onExit) == 0;
  (void)at_exit;  // if this is refused, memory is short, and the next allocation says so
  const std::string text = dir.string();
  prepared.dir[0] = '\0';
  if (text.size() < kLongestPath) std::memcpy(prepared.dir, text.c_str(), text.size() + 1);
  prepared.last_words = static_cast<const char* const*>(dlsym(RTLD_DEFAULT, "__abort_msg"));
  prepared.process.store(getpid());
  prepared.servo.store(&servo);
  onPlainExit([] { dieOfExit("a call of _exit()"); });
  os::onFatalSignals(&onFatal);
  os::onStopSignals(&onStop);
}

void forgetCrash() {
  os::onStopSignals(nullptr);
  os::onFatalSignals(nullptr);
  onPlainExit(nullptr);
  prepared.servo.store(nullptr);
}

void guardTheEnd(const std::filesystem::path& dir) {
#ifndef HAPTICD_SANITIZED
  static Ended& nothing = *new Ended;  // the handlers outlive every static object
  prepared.leaving.store(true);
  guardAgainstCrash(nothing, dir);
  os::onStopSignals(nullptr);
  onPlainExit(nullptr);
#else
  (void)dir;
#endif
}

CrashGuard::CrashGuard(Watched& servo, const std::filesystem::path& dir)
    : before_(prepared.servo.load()), dir_before_(prepared.dir) {
#ifndef HAPTICD_SANITIZED
  guardAgainstCrash(servo, dir);
#else
  (void)servo, (void)dir;
#endif
}

CrashGuard::~CrashGuard() {
#ifndef HAPTICD_SANITIZED
  forgetCrash();
  if (before_ != nullptr) guardAgainstCrash(*before_, dir_before_);
#endif
}

void endAnyway(const Owner* keeps) noexcept {
  Watched* servo = prepared.servo.load();
  if (servo == nullptr) endProcess(1);
  servo->cut(0);
  awaitCut(*servo);
  Line line;
  line.add("\nwarning: the run was told to end, and ");
  if (keeps != nullptr)
    addOwner(line, *keeps).add(" did not come back");
  else
    line.add("what it still did took too long");
  line.add("\n  ").add(servo->drives() ? "the motors are off; " : "").add("the process ends without its report\n");
  line.write(STDERR_FILENO);
  endProcess(1);
}

void dieOf(const char* reason, const Owner* culprit) noexcept {
  die(reason, culprit, Suspicion::kNone);
}

}  // namespace hapticd::watch
