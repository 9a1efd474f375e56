// Hot loops compiled for several instruction sets, the best one chosen when the program starts.
#pragma once

// Sanitizers run before the resolver of a multi-versioned function may be called, so there it is left out.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && !defined(__SANITIZE_ADDRESS__)
#define PELLUCID_MULTIVERSION __attribute__((target_clones("arch=x86-64-v3", "default")))
#else
#define PELLUCID_MULTIVERSION
#endif
