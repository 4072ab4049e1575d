// SPDX-License-Identifier: AGPL-3.0-or-later
// How long does one update of the soft tissue take on a bundled joint, and what of it?
// Run: ./bench_soft [joint.artus]   (default: the compiled shoulder of the tests)
// Read: CPU time of one thread. "two steps" is what a frame needs, "refresh" runs beside the
// frames. Budget: two steps and a snapshot within 12 ms. Peer: CHOLMOD's solution of as many
// unknowns, about 5 ms (docs/decisions/0007-own-factor.md).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <functional>
#include <string>
#include <vector>

#include "artus/detail/soft/solver/soft_body.h"
#include "tests/support/paths.h"

namespace {

using artus::Pose;
using artus::SoftBody;

double cpu_ms() {
  timespec t{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &t);
  return 1e3 * static_cast<double>(t.tv_sec) + 1e-6 * static_cast<double>(t.tv_nsec);
}

void measure(const char* what, int times, const std::function<void(int)>& work) {
  std::vector<double> ms;
  for (int k = 0; k < times; ++k) {
    const double from = cpu_ms();
    work(k);
    ms.push_back(cpu_ms() - from);
  }
  std::sort(ms.begin(), ms.end());
  const auto at = [&](double share) {
    return ms[static_cast<std::size_t>(share * static_cast<double>(ms.size() - 1))];
  };
  std::printf("%-22s p50 %8.2f  p99 %8.2f ms\n", what, at(0.5), at(0.99));
}

void run(SoftBody& body, const Pose& X_JP) {
  artus::SoftSolver& solver = body.solver();
  const artus::SoftModel& model = solver.model();
  std::printf("%zu cubes, %zu unknowns, %.2f million entries in the factor\n",
              model.cage().cells().size(), 3 * model.n_unknowns(),
              1e-6 * static_cast<double>(solver.factor().entries()));
  Pose pose = X_JP;
  measure("two steps", 150, [&](int k) {
    const double depth = 5e-3 * std::min(1.0, k / 50.0) + 0.3e-3 * std::sin(0.3 * k);
    pose.translation() = X_JP.translation() + depth * X_JP.linear().col(2);
    if (k % 12 == 0) solver.begin_refresh();
    if (k % 12 == 10) solver.end_refresh();
    for (int step = 0; step < 2; ++step) body.step(pose, 1.0 / 120);
  });
  measure("snapshot", 30, [&](int) { static_cast<void>(body.snapshot()); });
  artus::SoftForces forces;
  measure("forces of all cubes", 30,
          [&](int) { model.compute_forces(solver.displacements(), {}, forces); });
  Eigen::VectorXd x = Eigen::VectorXd::Ones(static_cast<Eigen::Index>(3 * model.n_unknowns()));
  measure("solution", 30, [&](int) { solver.factor().solve(x); });
  measure("refresh", 5, [&](int) { solver.refresh(); });
}

}  // namespace

int main(int argc, char** argv) {
  const std::filesystem::path file =
      argc > 1 ? std::filesystem::path(argv[1]) : artus::test::test_joints() / "shoulder.artus";
  auto read = artus::read_compiled_joint(file);
  if (!read) {
    std::fprintf(stderr, "%s\n", read.error().to_string().c_str());
    return EXIT_FAILURE;
  }
  const auto joint = std::make_shared<const artus::CompiledJoint>(std::move(*read));
  auto body = SoftBody::make(joint, joint->X_JP_default);
  if (!body) {
    std::fprintf(stderr, "%s\n", body.error().to_string().c_str());
    return EXIT_FAILURE;
  }
  run(*body, joint->X_JP_default);
  return EXIT_SUCCESS;
}
