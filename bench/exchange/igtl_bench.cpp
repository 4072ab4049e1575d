// SPDX-License-Identifier: AGPL-3.0-or-later
// Question: what does a picture cost that is sent to a program over OpenIGTLink?
// Command:  build/release/bench/exchange/bench_igtl
// Reading:  time is processor of the sender and of the server's thread together, from the pixels of
//           640 x 480 to the socket of one client, mean of 100 pictures.
// Budget:   1 ms, of 33 ms that a picture of 30 a second has.
#include <chrono>
#include <string>
#include <thread>

#include <benchmark/benchmark.h>

#include "artus/detail/exchange/igtl/contents.h"
#include "artus/detail/exchange/igtl/server.h"
#include "artus/detail/session/session_thread.h"
#include "tests/exchange/igtl_client.h"

namespace artus {
namespace {

constexpr int kWidth = 640;
constexpr int kHeight = 480;

void send_pictures(benchmark::State& state) {
  constexpr int kPictures = 100;
  igtl::Server::Options options;
  options.where.port = 0;
  auto server = igtl::Server::listen(
      options, [](const igtl::Message&) { return std::vector<igtl::Message>{}; });
  if (!server) return state.SkipWithError(server.error().to_string().c_str());
  test::IgtlClient client((*server)->port());
  while ((*server)->clients() == 0) std::this_thread::sleep_for(std::chrono::milliseconds(1));
  const std::string grey(kWidth * kHeight, 'g');
  igtl::Image image;
  image.width = kWidth;
  image.height = kHeight;
  image.image_to_reference.leftCols<3>().setIdentity();
  image.grey = grey;
  for (auto _ : state) {
    const std::int64_t before = (*server)->processor_ns();
    std::int64_t own = 0;
    for (int i = 0; i < kPictures; ++i) {
      const std::int64_t begin = thread_cpu_ns();
      igtl::Message message;
      message.type = "IMAGE";
      message.device = "Image_Reference";
      message.id = static_cast<std::uint32_t>(i);
      message.content = igtl::pack_image(image);
      (*server)->publish({message});
      own += thread_cpu_ns() - begin;
      if (!client.wait_for("IMAGE")) return state.SkipWithError("a picture did not arrive");
    }
    // until the server's thread has looked at its clock again
    std::this_thread::sleep_for(std::chrono::milliseconds(600));
    const std::int64_t spent = own + (*server)->processor_ns() - before;
    state.SetIterationTime(1e-9 * static_cast<double>(spent) / kPictures);
  }
}

BENCHMARK(send_pictures)->UseManualTime()->Iterations(5)->Unit(benchmark::kMillisecond);

}  // namespace
}  // namespace artus

BENCHMARK_MAIN();
