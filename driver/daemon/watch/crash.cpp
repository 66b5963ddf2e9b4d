// SPDX-License-Identifier: MIT
#include "watch/crash.hpp"

#include <fcntl.h>
#include <time.h>
#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstring>
#include <iterator>

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
  void write(int fd) const noexcept {
    if (::write(fd, text_, length_) < 0) return;  // there is nobody left to tell
  }

 private:
  char text_[3 * kLongestPath] = "";
  size_t length_ = 0;
};

/// Of that thread alone.
struct Death {
  std::atomic<size_t> step{0};  ///< the next of kSteps
  bool motors_off = false;
  const char* reason = "";
  Line black_box;  ///< its file, once it is written
};
Death death;

const char* words(int signal) noexcept {
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
  }
  return "a signal";
}

void onCrash(int signal) {
  dieOf(words(signal));
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

void cutMotors(Watched& servo) noexcept {
  servo.cut(0);
  death.motors_off = true;
}

void writeBlackBox(Watched& servo) noexcept {
  if (prepared.dir[0] == '\0' || servo.blackBox() == nullptr) return;
  const char* plugin = servo.plugin();
  Line file;
  file.add(prepared.dir).add("/black-box-").addName(plugin != nullptr ? plugin : "hapticd").add(".flight");
  saveBlackBox(servo, file.text());
  death.black_box = file;
}

void remember(Watched& servo) noexcept {
  const char* plugin = servo.plugin();
  if (plugin == nullptr || prepared.dir[0] == '\0') return;
  const int fd = open(Line().add(prepared.dir).add("/").add(kQuarantineFile).text(),
                      O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0640);
  if (fd < 0) return;
  Line().add(plugin).add("\t").add(death.reason).add("\n").write(fd);
  close(fd);
}

void tell(Watched& servo) noexcept {
  const char *plugin = servo.plugin(), *model = servo.model();
  Line line;
  line.add("\nerror: ").add(plugin != nullptr ? "plugin '" : "the daemon itself").add(plugin != nullptr ? plugin : "");
  if (plugin != nullptr) line.add("' of model '").add(model != nullptr ? model : "").add("'");
  line.add(" was ended by ").add(death.reason).add("\n  ");
  line.add(death.motors_off ? "the motors were switched off first" : "to switch the motors off crashed as well");
  if (*death.black_box.text() != '\0') line.add("; the last seconds are in ").add(death.black_box.text());
  line.add("\n  ");
  if (plugin != nullptr && prepared.dir[0] != '\0')
    line.add(
            "the next start leaves its models out\n  fix: look at the plugin (hapticd plugin check FILE.so), then: "
            "hapticd plugin clear ")
        .add(plugin)
        .add("\n");
  else
    line.add("the run has ended\n  fix: report it with the black box and the output of: hapticd doctor --json\n");
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
  const std::string text = dir.string();
  prepared.dir[0] = '\0';
  if (text.size() < kLongestPath) std::memcpy(prepared.dir, text.c_str(), text.size() + 1);
  prepared.servo.store(&servo);
  os::onCrashSignals(&onCrash);
}

void forgetCrash() {
  os::onCrashSignals(nullptr);
  prepared.servo.store(nullptr);
}

void dieOf(const char* reason) noexcept {
  Watched* servo = prepared.servo.load();
  if (servo == nullptr) _exit(1);
  int nobody = 0;
  const int self = os::threadId();
  if (!dying.compare_exchange_strong(nobody, self) && nobody != self) awaitEnd();
  // A step that crashes itself (the device's cut, on a heap just torn) brings this thread here again: on with the next.
  if (nobody == 0) death.reason = reason;
  for (size_t step = death.step++; step < std::size(kSteps); step = death.step++) kSteps[step](*servo);
  _exit(1);
}

}  // namespace hapticd::watch
