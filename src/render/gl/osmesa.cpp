#include "render/gl/osmesa.h"

#include <array>

#include <dlfcn.h>

#include "render/gl/gl.h"
#include "render/gl/gl_functions.h"

namespace pellucid::gl {

namespace {

// From OSMesa's interface (GL/osmesa.h), which is not needed to build.
constexpr int kOsMesaFormat = 0x22, kOsMesaProfile = 0x33, kOsMesaCoreProfile = 0x34;
constexpr int kOsMesaMajor = 0x36, kOsMesaMinor = 0x37, kOsMesaRgba = 0x1908, kOsMesaDepthBits = 0x30;

using CreateContextAttribs = void* (*)(const int*, void*);
using MakeCurrent = unsigned char (*)(void*, void*, unsigned, int, int);
using DestroyContext = void (*)(void*);
using GetProcAddress = void (*(*)(const char*))();

template <class Function>
Function symbol(void* library, const char* name) {
    return reinterpret_cast<Function>(dlsym(library, name));
}

template <class Function>
bool lead(Function& pointer, const char* name, GetProcAddress address) {
    const auto found = address(name);
    if (found == nullptr) return false;
    pointer = reinterpret_cast<Function>(found);
    return true;
}

/// Every function that src/render/gl calls.
bool leadEpoxyTo(GetProcAddress address, std::string& missing) {
#define PELLUCID_LEAD(function)                                                                                        \
    if (!lead(epoxy_##function, #function, address)) {                                                                 \
        missing = #function;                                                                                           \
        return false;                                                                                                  \
    }
    PELLUCID_GL_FUNCTIONS(PELLUCID_LEAD)
#undef PELLUCID_LEAD
    return true;
}

} // namespace

std::unique_ptr<OsMesaContext> OsMesaContext::tryMake(std::string& why) {
    std::unique_ptr<OsMesaContext> made(new OsMesaContext);
    for (const char* name : {"libOSMesa.so.8", "libOSMesa.so.6", "libOSMesa.so"})
        if (made->m_library == nullptr) made->m_library = dlopen(name, RTLD_LAZY | RTLD_LOCAL);
    const auto failed = [&](const std::string& reason) {
        why = reason;
        return nullptr;
    };
    if (made->m_library == nullptr) return failed("libOSMesa is missing");
    const auto create = symbol<CreateContextAttribs>(made->m_library, "OSMesaCreateContextAttribs");
    const auto makeCurrent = symbol<MakeCurrent>(made->m_library, "OSMesaMakeCurrent");
    const auto address = symbol<GetProcAddress>(made->m_library, "OSMesaGetProcAddress");
    if (create == nullptr || makeCurrent == nullptr || address == nullptr) return failed("libOSMesa is too old");
    const std::array<int, 11> wanted{kOsMesaFormat,
                                     kOsMesaRgba,
                                     kOsMesaDepthBits,
                                     0,
                                     kOsMesaProfile,
                                     kOsMesaCoreProfile,
                                     kOsMesaMajor,
                                     4,
                                     kOsMesaMinor,
                                     3,
                                     0};
    made->m_context = create(wanted.data(), nullptr);
    constexpr int kSide = 16;
    made->m_pixels.assign(4 * kSide * kSide, 0);
    if (made->m_context == nullptr ||
        makeCurrent(made->m_context, made->m_pixels.data(), GL_UNSIGNED_BYTE, kSide, kSide) == 0)
        return failed("no OpenGL 4.3");
    std::string missing;
    if (!leadEpoxyTo(address, missing)) return failed("no " + missing);
    return made;
}

OsMesaContext::~OsMesaContext() {
    if (m_context == nullptr) return;
    const auto makeCurrent = symbol<MakeCurrent>(m_library, "OSMesaMakeCurrent");
    makeCurrent(nullptr, nullptr, GL_UNSIGNED_BYTE, 0, 0);
    symbol<DestroyContext>(m_library, "OSMesaDestroyContext")(m_context);
    // The library stays: epoxy's pointers lead into it.
}

} // namespace pellucid::gl
