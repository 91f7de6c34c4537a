// Loops that are compiled for several instruction sets, of which the program picks at run time.
#pragma once

// Before a function whose loops should vectorise. The plain version and the wide ones compute the
// same bits: vector operations round like scalar ones, and -ffp-contract=off keeps multiplications
// and additions apart. Elsewhere than on x86-64 with GCC the plain version is all there is; so it
// is under the address sanitizer, which cannot start programs with run-time dispatch.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__)
#define TROFFER_MULTIVERSION __attribute__((target_clones("avx512f", "avx2", "default")))
#else
#define TROFFER_MULTIVERSION
#endif

// Functions that such loops call: a loop with a call left in it stays scalar.
#if defined(__GNUC__)
#define TROFFER_ALWAYS_INLINE __attribute__((always_inline)) inline
#else
#define TROFFER_ALWAYS_INLINE inline
#endif
