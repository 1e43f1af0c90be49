// SPDX-License-Identifier: GPL-3.0-or-later
// Hot loops compiled once more for wider vectors; the program picks at start what the machine has.
#pragma once

// Stands before a function whose loops work on integers or bits only: there every clone gives the
// same bits. A loop over floats must not have it, for wider clones fuse multiply and add.
//
// The choice runs before main(), hence before a sanitizer is ready; such builds get the plain loop.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
#define BINDERJET_VECTOR_CLONES __attribute__((target_clones("arch=x86-64-v4", "avx2", "default")))
#else
#define BINDERJET_VECTOR_CLONES
#endif
