// SPDX-License-Identifier: AGPL-3.0-or-later
#include "artus/detail/soft/cage/kernels.h"

#ifdef __x86_64__
#pragma GCC push_options
#pragma GCC target("avx512f,avx512vl,avx512dq")
namespace artus {
namespace {
constexpr std::size_t kRegister = 64;
#include "artus/detail/soft/cage/kernels_body.h"
}  // namespace

extern const SoftKernels kAvx512SoftKernels;
const SoftKernels kAvx512SoftKernels = kKernels;

}  // namespace artus
#pragma GCC pop_options
#endif
