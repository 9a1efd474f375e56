// A driver that ends the process as soon as EGL loads it.
#include <cstdlib>

namespace {
struct Crash {
    Crash() { std::abort(); }
} g_crash;
} // namespace
