// Takes the place of epoxy's library in programs that must not need it (docs/gpu-check.md): the function pointers that
// epoxy's headers declare, of those functions that we call. Each finds its function through libEGL when it is first
// called, and ends the process where there is none, as epoxy does.
#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include <dlfcn.h>
#include <epoxy/egl.h>

#include "render/gl/gl.h"
#include "render/gl/gl_functions.h"

namespace {

using Function = void (*)();

Function inLibrary(const char* name) {
    static void* const library = dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL);
    return library == nullptr ? nullptr : reinterpret_cast<Function>(dlsym(library, name));
}

/// EGL's own functions stand in the library; extensions and OpenGL are asked for.
Function find(const char* name) {
    if (const Function function = inLibrary(name)) return function;
    using GetProcAddress = Function (*)(const char*);
    static const auto getProcAddress = reinterpret_cast<GetProcAddress>(inLibrary("eglGetProcAddress"));
    if (getProcAddress != nullptr)
        if (const Function function = getProcAddress(name)) return function;
    std::fprintf(stderr, "libEGL.so.1 does not know %s\n", name);
    std::abort();
}

template <class Pointer, Pointer* pointer, const char* name>
struct FirstCall;
/// What a pointer leads to at first: finds the function, and goes on to it.
template <class Result, class... Arguments, Result (**pointer)(Arguments...), const char* name>
struct FirstCall<Result (*)(Arguments...), pointer, name> {
    static Result call(Arguments... arguments) {
        *pointer = reinterpret_cast<Result (*)(Arguments...)>(find(name));
        return (*pointer)(arguments...);
    }
};

} // namespace

#define PELLUCID_DEFINE(function)                                                                                      \
    static constexpr char k_##function[] = #function;                                                                  \
    decltype(epoxy_##function) epoxy_##function =                                                                      \
        FirstCall<decltype(epoxy_##function), &epoxy_##function, k_##function>::call;
PELLUCID_GL_FUNCTIONS(PELLUCID_DEFINE)
PELLUCID_EGL_FUNCTIONS(PELLUCID_DEFINE)
#undef PELLUCID_DEFINE

bool epoxy_extension_in_string(const char* list, const char* name) {
    // Whole words only: one extension's name may begin another's.
    const std::string_view all(list == nullptr ? "" : list), wanted(name);
    for (std::size_t start = 0; start < all.size();) {
        const std::size_t end = std::min(all.find(' ', start), all.size());
        if (all.substr(start, end - start) == wanted) return true;
        start = end + 1;
    }
    return false;
}

bool epoxy_has_egl_extension(EGLDisplay display, const char* name) {
    return epoxy_extension_in_string(eglQueryString(display, EGL_EXTENSIONS), name) ||
           epoxy_extension_in_string(eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS), name);
}
