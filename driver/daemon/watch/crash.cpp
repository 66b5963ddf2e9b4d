// SPDX-License-Identifier: MIT
#include "watch/crash.hpp"

#include <fcntl.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdlib>
#include <cstring>
#include <iterator>

#include "base/fatal_signals_posix.hpp"
#include "base/os.hpp"
#include "watch/quarantine.hpp"

namespace hapticd::watch {

namespace {

constexpr size_t kLongestPath = 1024;

/// Everything the handler needs, prepared while there is still an allocator.
struct Prepared {
  std::atomic<Watched*> servo{nullptr};
  char dir[kLongestPath] = "";  // "": nothing is written
};
Prepared prepared;
std::atomic<int> dying{0};  ///< the thread that ends the process

/// A line put together without the C library's buffers.
class Line {
 public:
  Line& add(const char* text) noexcept {
    for (; *text != '\0' && length_ + 1 < sizeof text_; ++text) text_[length_++] = *text;
    text_[length_] = '\0';
    return *this;
  }
  /// A plugin's name as part of a file's: whatever it holds, it stays in its folder.
  Line& addName(const char* name) noexcept {
    for (; *name != '\0' && length_ + 1 < sizeof text_; ++name) {
      const bool plain = (*name >= 'a' && *name <= 'z') || (*name >= 'A' && *name <= 'Z') ||
                         (*name >= '0' && *name <= '9') || *name == '_' || *name == '-';
      text_[length_++] = plain ? *name : '_';
    }
    text_[length_] = '\0';
    return *this;
  }
  const char* text() const noexcept { return text_; }
  bool write(int fd) const noexcept { return ::write(fd, text_, length_) == static_cast<ssize_t>(length_); }

 private:
  char text_[3 * kLongestPath] = "";
  size_t length_ = 0;
};

/// Of that thread alone. The reason and the culprit are fixed at the first step: what the later ones find is a process
/// that is falling apart.
struct Death {
  std::atomic<size_t> step{0};  ///< the next of kSteps
  bool motors_off = false;
  const Owner* culprit = nullptr;
  int not_remembered = 0;  ///< errno
  Line reason, black_box;  ///< its file, once it is written
};
Death death;

const char* wordsOfCrash(int signal) noexcept {
  switch (signal) {
    case SIGSEGV:
      return "a memory access that is not allowed (SIGSEGV)";
    case SIGBUS:
      return "a memory access that cannot be done (SIGBUS)";
    case SIGFPE:
      return "an arithmetic exception (SIGFPE)";
    case SIGILL:
      return "an instruction that this processor lacks (SIGILL)";
    case SIGABRT:
      return "an abort, such as a failed assertion (SIGABRT)";
    case SIGXCPU:
      return "a servo thread that never slept (SIGXCPU)";
    case SIGTRAP:
      return "a breakpoint without a debugger (SIGTRAP)";
    case SIGSYS:
      return "a system call that does not exist (SIGSYS)";
  }
  return nullptr;
}

Line words(int signal) noexcept {
  Line line;
  if (const char* known = wordsOfCrash(signal)) return line.add(known);
  line.add("a signal that ends a process (");
  if (const char* name = sigabbrev_np(signal)) return line.add("SIG").add(name).add(")");
  const int number = signal - SIGRTMIN;
  const char digits[] = {static_cast<char>('0' + number / 10 % 10), static_cast<char>('0' + number % 10), '\0'};
  return line.add("SIGRTMIN+").add(digits).add(")");
}

bool sentByOther(const siginfo_t& info) noexcept {
  return info.si_code <= 0 && info.si_code != SI_TIMER && info.si_pid != 0 && info.si_pid != getpid();
}

/// Whose code a signal came from. What another process sent, and what came to the process instead of to a thread, is
/// nobody's fault that is known: rather no name than a wrong one.
const Owner* culpritOf(int signal, const siginfo_t& info, const void* context) noexcept {
  const bool own_fault = wordsOfCrash(signal) != nullptr && info.si_code > 0;
  const bool raised = info.si_code == SI_TKILL && info.si_pid == getpid();
  if (!own_fault && !raised) return nullptr;
  if (const Owner* called = calledHere()) return called;
  return isWorker() ? nullptr : ownerInterrupted(context);  // a thread that a plugin or module began itself
}

void onFatal(int signal, siginfo_t* info, void* context) {
  Watched* servo = prepared.servo.load();
  if (servo != nullptr && wordsOfCrash(signal) == nullptr && sentByOther(*info)) {
    servo->stop();
    Line()
        .add("\nwarning: the run ends by ")
        .add(words(signal).text())
        .add(", which another process sent\n")
        .write(STDERR_FILENO);
    return;
  }
  dieOf(words(signal).text(), culpritOf(signal, *info, context));
}

/// A plugin or library that called exit(): static objects are still there, and other threads still run.
void onExit() {
  if (prepared.servo.load() == nullptr) return;
  const Owner* culprit = calledHere();
  if (culprit == nullptr && !isWorker()) culprit = ownerOnStack(__builtin_frame_address(0));
  dieOf("a call of exit()", culprit);
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

/// What an I/O thread has still to send goes with the process: it gets a moment.
void awaitCut(const Watched& servo) noexcept {
  constexpr timespec kPause{0, 500'000};
  constexpr int kPauses = 100;
  for (int i = 0; i < kPauses && !servo.cutLeft(); ++i) nanosleep(&kPause, nullptr);
}

void cutMotors(Watched& servo) noexcept {
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

/// A device module cannot be left out of the next start: it is named, and no more.
bool mayBeLeftOut() noexcept {
  return death.culprit != nullptr && !death.culprit->device && prepared.dir[0] != '\0';
}

void remember(Watched&) noexcept {
  if (!mayBeLeftOut()) return;
  errno = 0;
  const int fd = open(Line().add(prepared.dir).add("/").add(kQuarantineFile).text(),
                      O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0640);
  Line line;
  line.add(death.culprit->module.c_str()).add("\t").add(death.reason.text()).add("\n");
  const bool written = fd >= 0 && line.write(fd) && fsync(fd) == 0;
  if (!written) death.not_remembered = errno != 0 ? errno : ENOSPC;
  if (fd >= 0) close(fd);
}

void tellCulprit(Line& line) noexcept {
  line.add("\nerror: ");
  if (const Owner* culprit = death.culprit) {
    line.add(culprit->device ? "device module '" : "plugin '").add(culprit->module.c_str());
    line.add(culprit->device ? "' of device '" : "' of model '").add(culprit->name.c_str()).add("'");
  } else {
    line.add("the daemon itself");
  }
  line.add(" was ended by ").add(death.reason.text()).add("\n  ");
}

void tellCure(Line& line) noexcept {
  if (mayBeLeftOut() && death.not_remembered == 0) {
    line.add(
            "the next start leaves its models out\n  fix: look at the plugin (hapticd plugin check FILE.so), then: "
            "hapticd plugin clear ")
        .add(death.culprit->module.c_str())
        .add("\n");
  } else if (mayBeLeftOut()) {
    const char* why = strerrordesc_np(death.not_remembered);
    line.add("it could not be put in quarantine, so the next start loads it again: ").add(prepared.dir);
    line.add(": ").add(why != nullptr ? why : "not written").add("\n  fix: take it out of the scene\n");
  } else {
    line.add("the run has ended\n  fix: report it with the black box and the output of: hapticd doctor --json\n");
  }
}

void tell(Watched&) noexcept {
  Line line;
  tellCulprit(line);
  line.add(death.motors_off ? "the motors were switched off first" : "to switch the motors off crashed as well");
  if (*death.black_box.text() != '\0') line.add("; the last seconds are in ").add(death.black_box.text());
  line.add("\n  ");
  tellCure(line);
  line.write(STDERR_FILENO);
}

constexpr void (*kSteps[])(Watched&) noexcept = {&cutMotors, &remember, &writeBlackBox, &tell};

/// For a thread that finds another at it: that one ends the process, unless it is stuck itself.
[[noreturn]] void awaitEnd() noexcept {
  constexpr timespec kPatience{5, 0};
  nanosleep(&kPatience, nullptr);
  _exit(1);
}

}  // namespace

void guardAgainstCrash(Watched& servo, const std::filesystem::path& dir) {
  static const bool at_exit = std::atexit(&onExit) == 0 && std::at_quick_exit(&onExit) == 0;
  (void)at_exit;  // refused: out of memory, and the next allocation says so
  const std::string text = dir.string();
  prepared.dir[0] = '\0';
  if (text.size() < kLongestPath) std::memcpy(prepared.dir, text.c_str(), text.size() + 1);
  prepared.servo.store(&servo);
  os::onFatalSignals(&onFatal);
}

void forgetCrash() {
  os::onFatalSignals(nullptr);
  prepared.servo.store(nullptr);
}

void endAnyway(const Owner* keeps) noexcept {
  Watched* servo = prepared.servo.load();
  if (servo == nullptr) _exit(1);
  servo->cut(0);
  awaitCut(*servo);
  Line line;
  line.add("\nwarning: the run was told to end, and ");
  if (keeps != nullptr)
    line.add(keeps->device ? "device module '" : "plugin '").add(keeps->module.c_str()).add("' did not come back");
  else
    line.add("what it still did took too long");
  line.add("\n  the motors are off; the process ends without its report\n").write(STDERR_FILENO);
  _exit(1);
}

void dieOf(const char* reason, const Owner* culprit) noexcept {
  Watched* servo = prepared.servo.load();
  if (servo == nullptr) _exit(1);
  int nobody = 0;
  const int self = os::threadId();
  if (!dying.compare_exchange_strong(nobody, self) && nobody != self) awaitEnd();
  // A step that crashes itself (the device's cut, on a heap just torn) brings this thread here again: on with the next.
  if (nobody == 0) {
    death.reason.add(reason);
    death.culprit = culprit;
  }
  for (size_t step = death.step++; step < std::size(kSteps); step = death.step++) kSteps[step](*servo);
  _exit(1);
}

}  // namespace hapticd::watch
