// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/session/record/recorder.h"

#include <atomic>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <string>
#include <system_error>
#include <thread>
#include <utility>

#include "artus/detail/session/record/dropping_ring.h"

namespace artus {

struct Recorder::Impl {
  struct FileCloser {
    void operator()(std::FILE* file) const noexcept { std::fclose(file); }
  };
  std::unique_ptr<std::FILE, FileCloser> file;
  DroppingRing<TickRecord> ticks{16384};
  DroppingRing<FrameRecord> frames{1024};
  DroppingRing<PacketRecord> packets{1024};
  std::atomic<std::uint64_t> unwritten{0};  // that the file did not take
  std::atomic<int> error{0};                // errno of the first that it did not
  std::filesystem::path path;
  std::atomic<bool> stop{false};
  std::thread thread;

  template <class T>
  void write(std::uint32_t kind, const T& record) {
    const RecordStart start{kind, sizeof(T)};
    const bool good = std::fwrite(&start, sizeof start, 1, file.get()) == 1 &&
                      std::fwrite(&record, sizeof record, 1, file.get()) == 1;
    if (!good) note_failure();
  }
  void note_failure() {
    int none = 0;
    error.compare_exchange_strong(none, errno != 0 ? errno : EIO);
    ++unwritten;
  }
  void drain() {
    TickRecord tick;
    while (ticks.pop(tick)) write(RecordStart::kTick, tick);
    FrameRecord frame;
    while (frames.pop(frame)) write(RecordStart::kFrame, frame);
    PacketRecord packet;
    while (packets.pop(packet)) write(RecordStart::kPacket, packet);
  }
  void run() {
    while (!stop) {
      drain();
      if (std::fflush(file.get()) != 0) note_failure();  // so that a full disk is told in time
      std::this_thread::sleep_for(std::chrono::milliseconds(20));
    }
  }
};

Recorder::Recorder(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {
  impl_->thread = std::thread([this] { impl_->run(); });
}

Result<std::unique_ptr<Recorder>> Recorder::start(const std::filesystem::path& file,
                                                  const RecordingHead& head) {
  auto impl = std::make_unique<Impl>();
  impl->path = file;
  impl->file.reset(std::fopen(file.c_str(), "wb"));
  const std::string line = to_line(head) + "\n";
  if (!impl->file || std::fwrite(line.data(), 1, line.size(), impl->file.get()) != line.size())
    return fail(ErrorCode::unreadable, "cannot write the recording", file);
  return std::unique_ptr<Recorder>(new Recorder(std::move(impl)));
}

Recorder::~Recorder() {
  static_cast<void>(finish());
}

Result<void> Recorder::finish() {
  if (impl_->file) {
    impl_->stop = true;
    impl_->thread.join();
    impl_->drain();
    impl_->write(RecordStart::kEnd, dropped());
    if (std::fclose(impl_->file.release()) != 0) impl_->note_failure();
  }
  if (impl_->error == 0) return {};
  return fail(ErrorCode::unreadable, "the recording is not whole: " + trouble(), impl_->path);
}

std::string Recorder::trouble() const {
  return impl_->error == 0 ? std::string() : std::generic_category().message(impl_->error);
}

void Recorder::add(const TickRecord& record) noexcept {
  impl_->ticks.push(record);
}

void Recorder::add(const FrameRecord& record) noexcept {
  impl_->frames.push(record);
}

void Recorder::add(const PacketRecord& record) noexcept {
  impl_->packets.push(record);
}

std::uint64_t Recorder::dropped() const noexcept {
  return impl_->ticks.dropped() + impl_->frames.dropped() + impl_->packets.dropped() +
         impl_->unwritten;
}

}  // namespace artus
