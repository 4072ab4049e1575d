// SPDX-License-Identifier: AGPL-3.0-or-later
#pragma once

/// Compiles a hot loop for AVX-512, for AVX2 and for the baseline, and picks at load time. All give
/// the same bytes: no reassociation, no contraction. Sanitizers get the baseline alone.
#if defined(__x86_64__) && defined(__linux__) && !defined(__SANITIZE_ADDRESS__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__clang__)
#define ARTUS_SIMD __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define ARTUS_SIMD
#endif
