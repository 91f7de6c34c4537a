// Macros for loops that are compiled for several instruction sets; the program picks one at run
// time.
#pragma once

// Put it before a function whose loops should vectorise. All versions compute the same bits: vector
// operations round like scalar ones, and -ffp-contract=off forbids fused multiply-add. Only the
// plain version exists outside x86-64 with GCC and under the address sanitizer, which cannot start
// programs with run-time dispatch.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define TROFFER_MULTIVERSION __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define TROFFER_MULTIVERSION
#endif

// For functions that such loops call: a loop with a remaining call stays scalar.
#if defined(__GNUC__)
#define TROFFER_ALWAYS_INLINE __attribute__((always_inline)) inline
#else
#define TROFFER_ALWAYS_INLINE inline
#endif
