// SPDX-License-Identifier: MIT
#include "watch/crash_steps.hpp"

#include <fcntl.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstring>
#include <iterator>

#include "base/call_name.hpp"
#include "base/os.hpp"
#include "base/owner_file.hpp"
#include "watch/process_end.hpp"
#include "watch/quarantine.hpp"

namespace hapticd::watch {

namespace {

std::atomic<int> dying{0};  ///< number of the thread that ends the process; 0: none

/// Data of the thread that ends the process. The reason and the culprit are set before the first step, because later
/// steps may find a damaged process.
struct CrashSteps {
  std::atomic<size_t> step{0};  ///< index of the next step in kSteps
  const char* dir = "";         ///< see endInSteps()
  bool motors_off = false;
  const Owner* culprit = nullptr;
  bool called = false;         ///< true if the thread that ends the process was calling the culprit
  const char* call = nullptr;  ///< name of the called function; nullptr: a step
  Suspicion suspicion = Suspicion::kNone;
  int not_remembered = 0;  ///< errno, if the quarantine file could not be written; else 0
  Line reason, black_box;  ///< black_box: path of its file; "" until the file is written
};
CrashSteps crash_steps;

void saveBlackBox(const WatchTarget& servo, const char* file) noexcept {
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

void cutMotors(WatchTarget& servo) noexcept {
  if (!servo.drives()) return;
  cutAndAwait(servo);
  crash_steps.motors_off = true;
}

void writeBlackBox(WatchTarget& servo) noexcept {
  if (crash_steps.dir[0] == '\0' || servo.blackBox() == nullptr) return;
  Line file;
  file.add(crash_steps.dir).add("/black-box-");
  file.addName(crash_steps.culprit != nullptr ? crash_steps.culprit->module.c_str() : "hapticd").add(".flight");
  saveBlackBox(servo, file.text());
  crash_steps.black_box = file;
}

/// Returns the owners to put in quarantine, by number: the culprit, or, if memory was overwritten, all owners that do
/// not ship with hapticd. Returns nullptr if there are no more.
const Owner* leftOut(size_t number) noexcept {
  if (crash_steps.suspicion == Suspicion::kTorn) return foreignOwner(number);
  return number == 0 ? crash_steps.culprit : nullptr;
}

/// True if the next start can leave the culprit out. A device module cannot be left out: the message only names it.
bool mayBeLeftOut() noexcept {
  const Owner* first = leftOut(0);
  return first != nullptr && !first->device && crash_steps.dir[0] != '\0';
}

void remember(WatchTarget&) noexcept {
  if (!mayBeLeftOut()) return;
  errno = 0;
  const int fd = open(Line().add(crash_steps.dir).add("/").add(kQuarantineFile).text(),
                      O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0640);
  bool written = fd >= 0;
  for (size_t i = 0; const Owner* owner = leftOut(i); ++i) {
    Line line;
    const char* file = fileOf(owner);
    line.add(owner->module.c_str())
        .add("\t")
        .add(crash_steps.reason.text())
        .add(*file != '\0' ? "\t" : "")
        .add(file)
        .add("\n");
    written = written && line.write(fd);
  }
  written = written && fsync(fd) == 0;
  if (!written) crash_steps.not_remembered = errno != 0 ? errno : ENOSPC;
  if (fd >= 0) close(fd);
}

void printCulprit(Line& line) noexcept {
  line.add("\nerror: ");
  const Owner* culprit = crash_steps.culprit;
  const char* place = culprit != nullptr ? placeOf(culprit) : "";
  if (*place != '\0') line.add(place).add(": ");
  if (culprit != nullptr)
    addOwner(line, *culprit);
  else
    line.add("the daemon itself");
  line.add(" was ended by ").add(crash_steps.reason.text());
  if (culprit != nullptr && crash_steps.called) addCall(line.add(","), *culprit, crash_steps.call);
  if (crash_steps.suspicion == Suspicion::kTorn) line.add(": memory was overwritten, or freed twice");
  line.add("\n  ");
}

/// Adds all owners that do not ship with hapticd: "plugin 'torus' of model 'ring', plugin ...". Returns false if there
/// are none.
bool addForeign(Line& line) noexcept {
  size_t count = 0;
  for (; const Owner* owner = foreignOwner(count); ++count) addOwner(line.add(count > 0 ? ", " : ""), *owner);
  return count > 0;
}

/// Names the code that the user should test before reporting the daemon itself.
void printForeign(Line& line) noexcept {
  if (crash_steps.suspicion == Suspicion::kNone || foreignOwner(0) == nullptr) return;
  addForeign(line.add("the likeliest cause is code that does not ship with hapticd: "));
  line.add("\n  ");
}

/// True if the file of the culprit is not the one any more that was loaded.
bool hasChanged(const Owner* owner) noexcept {
  struct stat now{};
  const char* loaded = fileOf(owner);
  if (*loaded == '\0' || stat(pathOf(owner), &now) != 0) return false;
  Line identity;
  identity.addNumber(static_cast<uint64_t>(now.st_size)).add(" bytes of ");
  identity.addNumber(static_cast<uint64_t>(now.st_mtim.tv_sec)).add(".");
  identity.addNumber(static_cast<uint64_t>(now.st_mtim.tv_nsec)).add(" ");
  return std::strncmp(loaded, identity.text(), std::strlen(identity.text())) != 0;
}

/// A file that is written in place changes the code that runs, and then the plugin itself may be good.
void printChanged(Line& line) noexcept {
  if (crash_steps.culprit == nullptr || !hasChanged(crash_steps.culprit)) return;
  line.add(
      "its file has changed since it was loaded; if it was written in place, as by cp, the running code changed "
      "too: replace a plugin by mv or cmake --install, and then start the daemon again\n  ");
}

/// Adds the command that tests the file of a plugin or a device module.
Line& addCheck(Line& line, const Owner* owner) noexcept {
  const char* path = pathOf(owner);
  line.add(owner->device ? "hapticd device check " : "hapticd plugin check ");
  return line.add(*path != '\0' ? path : "FILE.so");
}

void printRemedy(Line& line, bool drives) noexcept {
  if (mayBeLeftOut() && crash_steps.not_remembered == 0) {
    addCheck(line.add("the next start leaves its models out\n  fix: look at the plugin ("), leftOut(0))
        .add("), then: hapticd plugin clear ")
        .add(leftOut(0)->module.c_str())
        .add("\n");
  } else if (mayBeLeftOut()) {
    const char* why = strerrordesc_np(crash_steps.not_remembered);
    line.add("it could not be put in quarantine, so the next start loads it again: ").add(crash_steps.dir);
    line.add(": ").add(why != nullptr ? why : "not written").add("\n  fix: remove it from the scene\n");
  } else if (crash_steps.culprit != nullptr) {
    line.add(drives ? "the run" : "the command").add(" has ended\n  fix: repair the ");
    line.add(crash_steps.culprit->device ? "module; " : "plugin; ");
    addCheck(line, crash_steps.culprit).add(" looks for the cause\n");
  } else if (crash_steps.suspicion != Suspicion::kNone && foreignOwner(0) != nullptr) {
    addCheck(line.add("the program has ended\n  fix: test that code first ("), foreignOwner(0))
        .add("); if it passes, report this with the output of: hapticd doctor --json\n");
  } else if (!drives) {
    line.add("the command has ended\n  fix: report it with the output of: hapticd doctor --json\n");
  } else {
    line.add("the run has ended\n  fix: report it with the black box and the output of: hapticd doctor --json\n");
  }
}

void printMessage(WatchTarget& servo) noexcept {
  Line line;
  printCulprit(line);
  if (servo.drives())
    line.add(crash_steps.motors_off ? "the motors were switched off first" : "switching the motors off crashed too");
  if (*crash_steps.black_box.text() != '\0')
    line.add("; the last seconds of the run are in ").add(crash_steps.black_box.text());
  if (servo.drives()) line.add("\n  ");
  printChanged(line);
  printForeign(line);
  printRemedy(line, servo.drives());
  line.write(STDERR_FILENO);
}

constexpr void (*kSteps[])(WatchTarget&) noexcept = {&cutMotors, &remember, &writeBlackBox, &printMessage};

/// Called by a thread if another thread is already ending the process: waits for it, and ends the process if that
/// thread does not.
[[noreturn]] void awaitEnd() noexcept {
  constexpr timespec kPatience{5, 0};
  nanosleep(&kPatience, nullptr);
  endProcess(1);
}

}  // namespace

void cutAndAwait(WatchTarget& servo) noexcept {
  constexpr timespec kPause{0, 500'000};
  constexpr int kPauses = 100;
  servo.cut(0);
  for (int i = 0; i < kPauses && !servo.cutLeft(); ++i) nanosleep(&kPause, nullptr);
}

Line& addOwner(Line& line, const Owner& owner) noexcept {
  line.add(owner.device ? "device module '" : "plugin '").add(owner.module.c_str());
  return line.add(owner.device ? "' of device '" : "' of model '").add(owner.name.c_str()).add("'");
}

Line& addCall(Line& line, const Owner& owner, const char* name) noexcept {
  if (name != nullptr) return line.add(" in its ").add(name).add("()");
  return line.add(owner.device ? " in one of its calls" : " in a step");
}

void endInSteps(WatchTarget* servo, const char* dir, const Cause& cause) noexcept {
  if (servo == nullptr) endProcess(1);
  int nobody = 0;
  const int self = os::threadId();
  if (!dying.compare_exchange_strong(nobody, self) && nobody != self) awaitEnd();
  // If a step crashes itself (such as the device's cut, with a damaged heap), this thread comes here again, and
  // continues with the next step.
  if (nobody == 0) {
    crash_steps.dir = dir;
    crash_steps.reason.add(cause.reason);
    crash_steps.culprit = cause.culprit;
    crash_steps.suspicion = cause.suspicion;
    crash_steps.called = cause.culprit != nullptr && cause.culprit == currentOwner();
    crash_steps.call = callNameHere();
  }
  for (size_t step = crash_steps.step++; step < std::size(kSteps); step = crash_steps.step++) kSteps[step](*servo);
  endProcess(1);
}

}  // namespace hapticd::watch
