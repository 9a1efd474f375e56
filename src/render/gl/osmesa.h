// OSMesa: Mesa's rasterizer drawing into plain memory, for machines without EGL. Loaded when it is needed; the program
// does not depend on it.
#pragma once

#include <memory>
#include <string>
#include <vector>

namespace pellucid::gl {

/// Current on the thread that made it, until it dies there.
///
/// epoxy cannot find OSMesa's functions (they belong to no window system), so while such a context lives epoxy's
/// function pointers lead to OSMesa, in the whole process. It is therefore made only where EGL gave no context.
class OsMesaContext {
public:
    /// Null, with the reason in `why`, where the library is missing or older than OpenGL 4.3.
    static std::unique_ptr<OsMesaContext> tryMake(std::string& why);
    ~OsMesaContext();
    OsMesaContext(const OsMesaContext&) = delete;
    OsMesaContext& operator=(const OsMesaContext&) = delete;

private:
    OsMesaContext() = default;
    void* m_library = nullptr;
    void* m_context = nullptr;
    std::vector<unsigned char> m_pixels; ///< OSMesa wants a buffer, nothing is drawn into it
};

} // namespace pellucid::gl
