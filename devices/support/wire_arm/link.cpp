// SPDX-License-Identifier: MIT
#include "wire_arm/link.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace hapticd::wire_arm {
namespace {

constexpr Nanoseconds kMillisecond = 1'000'000;
constexpr Nanoseconds kSearchPause = 100 * kMillisecond;   ///< time between two searches for a lost device
constexpr Nanoseconds kFirstReport = 1000 * kMillisecond;  ///< longest wait for the first report
constexpr Nanoseconds kOld = 5 * kMillisecond;  ///< reports that waited in the kernel arrive within this time
constexpr int kMostReportsAtOnce = 64;          ///< number of reports that the kernel keeps for a hidraw device
constexpr int kAbove = 1;                       ///< added to the servo's priority, because a late sample is useless

void pause(Nanoseconds time) noexcept {
  RealClock clock(0);
  clock.waitUntil(clock.now() + time);
}

Nanoseconds nanoseconds(double seconds) {
  return static_cast<Nanoseconds>(std::llround(seconds * 1e9));
}

Trouble troubleOf(Status status) {
  if (status == Status::kStalled) return Trouble::kStalled;
  if (status == Status::kAbsent) return Trouble::kAbsent;
  return status == Status::kGone ? Trouble::kUnplugged : Trouble::kBusError;
}

}  // namespace

Link::Link(std::unique_ptr<Transport> transport, const codec::Wire& wire, LinkSettings settings)
    : transport_(std::move(transport)),
      wire_(wire),
      settings_(std::move(settings)),
      session_(wire, settings_.session),
      period_(nanoseconds(1 / wire.rate)) {}

Link::~Link() {
  close();
}

Result<Identity> Link::open() {
  auto opened = bringUp();
  if (opened) open_ = true;
  return opened;
}

Result<Identity> Link::bringUp() {
  Address address = settings_.address;
  // Another arm of the same kind may be free, and its hand expects no force. So a lost arm is replaced by itself only.
  if (address.serial.empty()) address.serial = identity_.serial;
  auto opened = transport_->open(address, wire_);
  if (!opened) return opened;
  auto started = startUp();
  if (started && settings_.prepare) started = settings_.prepare(*transport_);
  if (!started) {
    transport_->close();
    return Error{started.error()};
  }
  const Zero zero = settings_.zero ? settings_.zero(*opened) : Zero{};
  session_.attach(monotonicNow(), zero.offset, zero.known);
  prepareSilence();
  const std::lock_guard lock(mutex_);
  identity_ = *opened;
  return opened;
}

/// Prepares the report that switches the motors off. Its sequence number is far from those of commands, so that a
/// device that ignores repeated numbers still obeys it.
void Link::prepareSilence() {
  constexpr uint32_t kFar = 0x5a5a5a5a;
  std::array<uint8_t, codec::kMaxReportBytes> report{};
  codec::Order off;
  off.sequence = kFar;
  const size_t size = codec::encode(wire_.output, off, report);
  reported_.store(false, std::memory_order_relaxed);
  const std::lock_guard lock(mutex_);
  const uint64_t epoch = silence_.epoch + 1;
  silence_ = {};
  silence_.struct_size = sizeof silence_;
  silence_.epoch = epoch;
  silence_descriptor_ = transport_->openForSilence(silence_);
  if (silence_.size + size > sizeof silence_.bytes) silence_descriptor_ = Descriptor();
  if (!silence_descriptor_) return;
  std::copy_n(report.begin(), size, silence_.bytes + silence_.size);
  silence_.size += static_cast<uint32_t>(size);
  silence_.fd = silence_descriptor_.get();
}

bool Link::silence(hdv_silence& how) const {
  const std::lock_guard lock(mutex_);
  how = silence_;
  return silence_descriptor_ && reported_.load(std::memory_order_relaxed);
}

Result<void> Link::startUp() {
  for (size_t i = 0; i < wire_.startup.size(); ++i)
    if (auto done = perform(wire_.startup[i]); !done)
      return Error{"start-up step " + std::to_string(i + 1) + " of " + std::to_string(wire_.startup.size()) + ": " +
                   done.error()};
  return {};
}

Result<void> Link::perform(const codec::StartStep& step) {
  for (int attempt = 0; attempt < step.tries; ++attempt) {
    if (step.is_control && transport_->control(step) != Status::kOk) continue;
    if (!step.send.empty() && transport_->send(step.send) != Status::kOk) continue;
    if (step.expect.empty()) return pause(nanoseconds(step.wait)), Result<void>{};
    const Nanoseconds until = monotonicNow() + nanoseconds(step.timeout);
    size_t matched = 0;
    while (matched < step.expect.size() && monotonicNow() < until) {
      size_t size = 0;
      const Status status = transport_->receive(in_, size, kMillisecond);
      if (status != Status::kOk && status != Status::kNothing) break;
      const size_t packet = std::max<size_t>(1, wire_.framing.used ? wire_.framing.packet : in_.size());
      for (size_t i = 0; i < size && matched < step.expect.size(); ++i)
        if (!wire_.framing.used || i % packet >= wire_.framing.header)
          matched = in_[i] == step.expect[matched] ? matched + 1 : (in_[i] == step.expect[0] ? 1 : 0);
    }
    if (matched == step.expect.size()) return pause(nanoseconds(step.wait)), Result<void>{};
  }
  return Error{"the device did not answer as the device file says after " + std::to_string(step.tries) +
               " tries; check that its firmware is the version of the device file"};
}

Result<void> Link::start() {
  if (!open_) return Error{"the arm is not open"};
  stop_ = false;
  if (const auto code = thread_.start("hapticd-io", [this] { run(); }))
    return Error{"its I/O thread cannot be started: " + code.message()};
  const Nanoseconds until = monotonicNow() + kFirstReport;
  while (monotonicNow() < until) {
    pause(kMillisecond);
    if (samples_.update() && samples_.front().sequence > 0) return {};
  }
  stop();
  return Error{"opened, but " + std::string(describe(session_.trouble())) + "; expected " +
               std::to_string(static_cast<int>(wire_.rate)) + " reports per second; the motors stay off"};
}

Result<void> Link::capture(hdv_take_transfer take, void* who) {
  if (!open_) return Error{"the arm is not open"};
  const Nanoseconds begun = monotonicNow();
  Nanoseconds due = begun;
  for (bool more = true; more;) {
    if (const Nanoseconds now = monotonicNow(); now >= due) {
      size_t size = session_.command(now, ArmCommand{}, out_);
      due = std::max(due + period_, now);
      if (const Status sent = transport_->send({out_.data(), size}); sent == Status::kGone)
        return Error{"the arm was unplugged"};
      more = take(who, now - begun, 1, out_.data(), size) == 0;
    }
    size_t size = 0;
    const Nanoseconds now = monotonicNow();
    const Status status = transport_->receive(in_, size, due > now ? std::min(due - now, kMillisecond) : 0);
    if (status == Status::kGone) return Error{"the arm was unplugged"};
    if (status == Status::kOk) more = take(who, monotonicNow() - begun, 0, in_.data(), size) == 0 && more;
  }
  return {};
}

void Link::stop() {
  stop_ = true;
  thread_.join();
}

void Link::close() {
  stop();
  if (open_) transport_->close();
  open_ = false;
}

bool Link::read(Sample& sample) noexcept HSP_RT {
  heard_ = news_.strikes();
  const bool fresh = samples_.update();
  sample = samples_.front();
  return fresh;
}

void Link::write(const ArmCommand& wanted) noexcept HSP_RT {
  commands_.back() = wanted;
  commands_.publish();
  commanded_.strike();
}

void Link::waitForNews(Nanoseconds until) noexcept {
  paced_.store(true, std::memory_order_relaxed);
  commanded_.wake();
  news_.wait(heard_, until);
}

void Link::cut() noexcept {
  cut_left_.store(false);
  cut_.store(true);
  commanded_.strike();
}

void Link::run() noexcept {
  if (os::setFifo(os::kServoPriority + kAbove)) (void)os::setFifo(os::kServoPriority);
  if (open_) forgetOld();
  due_ = monotonicNow();
  while (!stop_.load(std::memory_order_relaxed)) {
    if (open_)
      serve(monotonicNow());
    else
      findDevice();
    logTrouble();
  }
  if (!open_) return;
  const size_t size = session_.command(monotonicNow(), ArmCommand{}, out_);  // motors off
  (void)transport_->send({out_.data(), size});
}

/// Drops reports that are older than this thread: the arm may have moved since then, so the next report would look like
/// a jump.
void Link::forgetOld() noexcept {
  size_t size = 0;
  for (const Nanoseconds until = monotonicNow() + kOld; monotonicNow() < until;)
    if (const Status status = transport_->receive(in_, size, kMillisecond);
        status != Status::kOk && status != Status::kNothing)
      return;
}

void Link::serve(Nanoseconds now) noexcept {
  session_.calibrateByDevice(calibrate_.load(std::memory_order_relaxed));
  commands_.update();
  const bool news = wire_.exchange == codec::Exchange::kStream && commands_.front().sequence != sent_command_ &&
                    now - sent_at_ >= period_ / 2;
  const bool cut = cut_.load(std::memory_order_relaxed) && !cut_sent_;
  if (((now >= due_ || news) && readUntil(now) == 0) || cut) send(now);
  if (!open_) return;
  now = monotonicNow();
  const Nanoseconds next = std::max(due_, readUntil(now)), wait = next > now ? next - now : 0;
  // hidapi knows only timeouts of whole milliseconds. The reports of a streaming arm end the wait in time. A polled arm
  // that has answered sends no report until it is asked again, so there is no wait for it.
  if (answered_ && wire_.exchange == codec::Exchange::kPoll)
    pause(wait);
  else
    receive(wait);
  if (open_ && session_.watch(monotonicNow())) publish();
}

/// Takes the present positions as those of the pose. Only good reports say where the arm is now.
void Link::takeZero() noexcept {
  const Trouble trouble = session_.trouble();
  if (trouble != Trouble::kNone && trouble != Trouble::kJump) return;
  const std::lock_guard lock(mutex_);
  for (size_t i = 0; i < settings_.session.joints; ++i) offset_[i] = pose_[i] - session_.raw()[i];
  session_.setZero(offset_);
  publish();
  zero_wanted_ = false;
  zero_done_.store(true, std::memory_order_release);
}

void Link::receive(Nanoseconds wait) noexcept {
  bool fresh = false;
  int taken = 0;
  for (; taken < kMostReportsAtOnce && open_; ++taken) {
    size_t size = 0;
    const Status status = transport_->receive(in_, size, taken == 0 ? wait : 0);
    if (status == Status::kNothing) break;
    if (status != Status::kOk) return lose(troubleOf(status));
    fresh = session_.receive(monotonicNow(), {in_.data(), size}) || fresh;
    if (session_.trouble() != Trouble::kNone) publish();
  }
  answered_ = answered_ || fresh;
  if (fresh) reported_at_ = monotonicNow(), reported_.store(true, std::memory_order_relaxed);
  if (fresh && zero_wanted_.load(std::memory_order_acquire)) takeZero();
  if (fresh) publishToServo();
  // This thread must sleep, because its priority is above the servo's: also if a device sends without end.
  if (taken == kMostReportsAtOnce) pause(period_ / 2);
}

/// Publishes the newest sample. If the samples pace the servo, the servo answers each sample at once. So this function
/// waits for the command instead of the next report. Reports that come meanwhile wait in the kernel.
void Link::publishToServo() noexcept {
  const uint32_t known = commanded_.strikes();
  publish();
  if (paced_.load(std::memory_order_relaxed) && wire_.exchange == codec::Exchange::kStream)
    commanded_.wait(known, monotonicNow() + period_ / 2);
}

/// Chooses when to ask a polled arm, so that its answer comes in the middle between two reads of the servo. Then each
/// read finds a new sample, for any phase between the two loops.
Nanoseconds Link::midway(Nanoseconds due) const noexcept {
  constexpr int64_t kShare = 8;  // each command corrects 1 / kShare of the error, so one late command changes little
  const auto period = static_cast<int64_t>(period_), at = static_cast<int64_t>(due);
  const auto read = static_cast<int64_t>(commands_.front().time);
  const bool follows = paced_.load(std::memory_order_relaxed);  // paced: the servo reads when the answer comes
  if (read == 0 || follows || wire_.exchange != codec::Exchange::kPoll) return due;
  const int64_t phase = ((at - read) % period + period) % period;
  return static_cast<Nanoseconds>(at - (phase - period / 2) / kShare);
}

/// A board that shares memory with this computer reads the command shortly before it writes its next report. If both
/// have the same rate, it would find each command half written, until their clocks have drifted apart. So no command is
/// written then, unless the report is late. Returns until when [ns], or 0 if a command may be written now.
Nanoseconds Link::readUntil(Nanoseconds now) const noexcept {
  if (!transport_->sharesMemory() || reported_at_ == 0) return 0;
  const Nanoseconds expected = reported_at_ + period_, begin = expected - period_ / 3, end = expected + period_ / 4;
  return now >= begin && now < end ? end : 0;
}

void Link::send(Nanoseconds now) noexcept {
  cut_sent_ = cut_.load(std::memory_order_relaxed);
  const size_t size = session_.command(now, cut_sent_ ? ArmCommand{} : commands_.front(), out_);
  sent_command_ = commands_.front().sequence;
  sent_at_ = now;
  due_ += period_;
  if (due_ + 10 * period_ < now || due_ > now + period_) due_ = now + period_;
  due_ = midway(due_);
  answered_ = false;
  const Status status = transport_->send({out_.data(), size});
  if (status != Status::kOk && status != Status::kNothing) return lose(troubleOf(status));
  if (cut_sent_) cut_left_.store(true);
}

void Link::lose(Trouble trouble) noexcept {
  session_.lose(monotonicNow(), trouble);
  transport_->close();
  open_ = false;
  cut_left_.store(true);  // there is no arm to which a cut could be sent
  publish();
}

/// Tries to open the lost arm again: at once, then ten times a second. If a device opens and fails again and again,
/// this thread must still sleep, because its priority is above the servo's.
void Link::findDevice() noexcept {
  while (monotonicNow() < tried_at_ + kSearchPause && !stop_) pause(10 * kMillisecond);
  if (stop_) return;
  tried_at_ = monotonicNow();
  try {
    auto found = bringUp();
    open_ = static_cast<bool>(found);
    if (open_) {
      due_ = monotonicNow();
      refusal_.clear();
      back_ = found->product + " " + found->serial + " is back; its force ramps in again";
    } else if (found.error() != refusal_) {
      refusal_ = found.error();
      settings_.log(HSP_LOG_DEBUG, "still missing: " + refusal_);
    }
  } catch (const std::exception& e) {
    open_ = false;  // for example no memory: the next search may succeed
  }
}

void Link::logTrouble() noexcept {
  const Trouble now = session_.trouble();
  if (now == told_ || session_.sample().sequence == 0) return;  // before the first report, start() reports the trouble
  told_ = now;
  try {
    if (now == Trouble::kNone)
      settings_.log(HSP_LOG_INFO, std::exchange(back_, "healthy"));
    else
      settings_.log(HSP_LOG_WARNING, std::string(describe(now)) +
                                         "\n  its force is off until it is healthy again\n  fix: "
                                         "hapticd device info FILE shows the arm, hapticd doctor shows what is wrong");
  } catch (const std::exception& e) {
    return;  // without memory there is no message
  }
}

void Link::publish() noexcept {
  samples_.back() = session_.sample();
  samples_.publish();
  news_.ring();
}

Result<JointArray> Link::calibrateAt(const JointArray& pose) {
  {
    const std::lock_guard lock(mutex_);
    pose_ = pose;
  }
  zero_done_ = false;
  zero_wanted_.store(true, std::memory_order_release);
  for (int i = 0; i < 1000; ++i) {
    if (zero_done_.load(std::memory_order_acquire)) return offset_;
    pause(kMillisecond);
  }
  zero_wanted_ = false;
  samples_.update();
  return Error{"its positions are not known: " + std::string(describe(samples_.front().trouble))};
}

Identity Link::identity() const {
  const std::lock_guard lock(mutex_);
  return identity_;
}

}  // namespace hapticd::wire_arm
