#include "render/gl/gl_engines.h"

#include <algorithm>
#include <cctype>

#include "base/error.h"
#include "render/gl/headless_context.h"

namespace pellucid {

bool isSoftwareRenderer(std::string renderer) {
    std::transform(renderer.begin(), renderer.end(), renderer.begin(), [](unsigned char c) { return std::tolower(c); });
    for (const char* name : {"llvmpipe", "softpipe", "swrast", "software", "swiftshader", "swr"})
        if (renderer.find(name) != std::string::npos) return true;
    return false;
}

std::optional<GlInfo> probeGl() {
    try {
        return gl::HeadlessContext().info();
    } catch (const Error&) {
        return {};
    }
}

} // namespace pellucid
