#include "render/gl/headless_context.h"

#include <array>
#include <cstdio>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include <dlfcn.h>
#include <epoxy/egl.h>

#include "base/check.h"
#include "base/error.h"
#include "base/text.h"
#include "render/gl/gl.h"
#include "render/gl/gl_resources.h"
#include "render/gl/osmesa.h"
#include "render/gl/shader_program.h"

namespace pellucid::gl {

namespace {

GlInfo describe(const std::string& platform) {
    const auto text = [](GLenum what) {
        const GLubyte* s = glGetString(what);
        return std::string(s ? reinterpret_cast<const char*>(s) : "");
    };
    GlInfo info{text(GL_VENDOR), text(GL_RENDERER), text(GL_VERSION), platform, false, {}};
    info.software = isSoftwareRenderer(info.renderer);
    const auto limit = [&](const char* name, GLenum what) { info.limits.emplace_back(name, glInteger(what)); };
    limit("max_3d_texture_size", GL_MAX_3D_TEXTURE_SIZE);
    limit("max_texture_size", GL_MAX_TEXTURE_SIZE);
    limit("max_array_texture_layers", GL_MAX_ARRAY_TEXTURE_LAYERS);
    limit("max_texture_image_units", GL_MAX_TEXTURE_IMAGE_UNITS);
    limit("max_compute_texture_image_units", GL_MAX_COMPUTE_TEXTURE_IMAGE_UNITS);
    limit("max_compute_work_group_invocations", GL_MAX_COMPUTE_WORK_GROUP_INVOCATIONS);
    limit("max_compute_shared_memory_size", GL_MAX_COMPUTE_SHARED_MEMORY_SIZE);
    limit("max_shader_storage_block_size", GL_MAX_SHADER_STORAGE_BLOCK_SIZE);
    return info;
}

/// A context that is current on the thread that made it, until it dies there.
class EglContext {
public:
    EglContext(EGLDisplay display, EGLContext context) : m_display(display), m_context(context) {}
    EglContext(const EglContext&) = delete;
    EglContext& operator=(const EglContext&) = delete;
    ~EglContext() {
        eglMakeCurrent(m_display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(m_display, m_context);
        eglReleaseThread();
        // The display is not terminated: it is shared with every other context of this process, the window's too.
    }

private:
    EGLDisplay m_display;
    EGLContext m_context;
};

struct Candidate {
    std::string platform; ///< for people
    EGLDisplay display = EGL_NO_DISPLAY;
};

bool haveEgl() {
    // epoxy ends the process where libEGL is missing, so look before it does.
    void* library = dlopen("libEGL.so.1", RTLD_LAZY | RTLD_LOCAL);
    return library != nullptr; // kept open: epoxy needs it from here on
}

bool hasExtension(const char* list, const char* name) {
    return list != nullptr && epoxy_extension_in_string(list, name);
}

std::vector<Candidate> eglCandidates() {
    std::vector<Candidate> all;
    const char* client = eglQueryString(EGL_NO_DISPLAY, EGL_EXTENSIONS);
    const bool platforms = hasExtension(client, "EGL_EXT_platform_base");
    std::vector<Candidate> softwareDevices;
    if (platforms && hasExtension(client, "EGL_EXT_platform_device") &&
        (hasExtension(client, "EGL_EXT_device_enumeration") || hasExtension(client, "EGL_EXT_device_base"))) {
        std::array<EGLDeviceEXT, 32> devices{};
        EGLint count = 0;
        if (eglQueryDevicesEXT(static_cast<EGLint>(devices.size()), devices.data(), &count) != EGL_TRUE) count = 0;
        for (int i = 0; i < count; ++i) {
            const EGLDeviceEXT device = devices[static_cast<std::size_t>(i)];
            const bool software =
                hasExtension(eglQueryDeviceStringEXT(device, EGL_EXTENSIONS), "EGL_MESA_device_software");
            const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, device, nullptr);
            (software ? softwareDevices : all).push_back({"EGL device " + std::to_string(i), display});
        }
    }
    if (platforms && hasExtension(client, "EGL_MESA_platform_surfaceless"))
        all.push_back(
            {"EGL surfaceless", eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)});
    all.insert(all.end(), softwareDevices.begin(), softwareDevices.end());
    all.push_back({"EGL default display", EGL_NO_DISPLAY}); // asked for only when its turn comes
    return all;
}

/// For tests: what the driver calls an error is printed and ends the program. A shader that does not compile is left to
/// Program, which says where.
bool errorsEndTheProgram() { return std::getenv("PELLUCID_GL_DEBUG") != nullptr; }

void watchErrors() {
    if (!errorsEndTheProgram()) return;
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS); // so that the place is on the stack
    glDebugMessageCallback(
        [](GLenum source, GLenum type, GLuint, GLenum, GLsizei, const GLchar* text, const void*) {
            if (type != GL_DEBUG_TYPE_ERROR || source == GL_DEBUG_SOURCE_SHADER_COMPILER) return;
            std::fprintf(stderr, "OpenGL: %s\n", text);
            std::abort();
        },
        nullptr);
}

/// Makes a surfaceless context current; null, with the reason in `why`, where this display gives none.
std::unique_ptr<EglContext> makeCurrentOn(EGLDisplay display, std::string& why) {
    const auto failed = [&](const char* reason) {
        why = reason;
        return nullptr;
    };
    EGLint major = 0, minor = 0;
    if (display == EGL_NO_DISPLAY || eglInitialize(display, &major, &minor) != EGL_TRUE) return failed("no display");
    if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context")) return failed("no surfaceless contexts");
    if (eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) return failed("no desktop OpenGL");
    const std::array<EGLint, 5> wanted{EGL_SURFACE_TYPE, EGL_DONT_CARE, EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (eglChooseConfig(display, wanted.data(), &config, 1, &count) != EGL_TRUE || count < 1)
        return failed("no configuration");
    for (const int version : {45, 43}) {
        const std::array<EGLint, 9> attributes{EGL_CONTEXT_MAJOR_VERSION,
                                               version / 10,
                                               EGL_CONTEXT_MINOR_VERSION,
                                               version % 10,
                                               EGL_CONTEXT_OPENGL_PROFILE_MASK,
                                               EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                                               EGL_CONTEXT_OPENGL_DEBUG,
                                               errorsEndTheProgram() ? EGL_TRUE : EGL_FALSE,
                                               EGL_NONE};
        const EGLContext context = eglCreateContext(display, config, EGL_NO_CONTEXT, attributes.data());
        if (context == EGL_NO_CONTEXT) continue;
        auto owner = std::make_unique<EglContext>(display, context);
        if (eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context) == EGL_TRUE) return owner;
    }
    return failed("no OpenGL 4.3");
}

/// What the thread holds while it lives.
struct CurrentContext {
    std::unique_ptr<EglContext> egl;
    std::unique_ptr<OsMesaContext> osmesa;
    GlInfo info;
};

CurrentContext makeAnyCurrent() {
    std::string reasons;
    const auto note = [&](const std::string& platform, const std::string& why) {
        reasons += (reasons.empty() ? "" : "; ") + platform + ": " + why;
    };
    CurrentContext current;
    const char* wanted = std::getenv("PELLUCID_GL_PLATFORM");
    if (wanted != nullptr && std::string(wanted) == "osmesa")
        note("EGL", "PELLUCID_GL_PLATFORM says osmesa");
    else if (!haveEgl())
        note("EGL", "libEGL.so.1 is missing");
    else
        for (const Candidate& candidate : eglCandidates()) {
            const EGLDisplay display =
                candidate.display == EGL_NO_DISPLAY && candidate.platform == "EGL default display"
                    ? eglGetDisplay(EGL_DEFAULT_DISPLAY)
                    : candidate.display;
            std::string why;
            current.egl = makeCurrentOn(display, why);
            if (current.egl) {
                requireGl43();
                watchErrors();
                current.info = describe(candidate.platform);
                return current;
            }
            note(candidate.platform, why);
        }
    std::string why;
    current.osmesa = OsMesaContext::tryMake(why);
    if (current.osmesa) {
        current.info = describe("OSMesa");
        return current;
    }
    note("OSMesa", why);
    throw Error("no OpenGL 4.3 context without a window (" + reasons + ")", "OpenGL",
                "install a graphics driver or Mesa", Remedy::OtherEngine);
}

} // namespace

HeadlessContext::HeadlessContext() : m_thread([this] { threadMain(); }) {
    std::unique_lock lock(m_mutex);
    m_changed.wait(lock, [&] { return m_ready; });
    if (!m_error) return;
    lock.unlock();
    m_thread.join();
    std::rethrow_exception(m_error);
}

HeadlessContext::~HeadlessContext() {
    {
        std::lock_guard lock(m_mutex);
        m_quit = true;
    }
    m_changed.notify_all();
    m_thread.join();
}

void HeadlessContext::run(const std::function<void()>& work) {
    PELLUCID_CHECK(std::this_thread::get_id() != m_thread.get_id());
    std::lock_guard caller(m_callers);
    std::unique_lock lock(m_mutex);
    m_work = &work;
    m_changed.notify_all();
    m_changed.wait(lock, [&] { return m_work == nullptr; });
    if (m_error) std::rethrow_exception(std::exchange(m_error, nullptr));
}

void HeadlessContext::threadMain() {
    std::optional<CurrentContext> current;
    std::unique_lock lock(m_mutex);
    try {
        current.emplace(makeAnyCurrent());
        m_info = current->info;
    } catch (...) {
        m_error = std::current_exception();
    }
    m_ready = true;
    m_changed.notify_all();
    if (!current) return;
    for (;;) {
        m_changed.wait(lock, [&] { return m_work != nullptr || m_quit; });
        if (m_work == nullptr) return;
        const auto* work = m_work;
        lock.unlock();
        std::exception_ptr error;
        try {
            (*work)();
        } catch (...) {
            error = std::current_exception();
        }
        lock.lock();
        m_error = error;
        m_work = nullptr;
        m_changed.notify_all();
    }
}

} // namespace pellucid::gl

namespace pellucid {

bool isSoftwareRenderer(const std::string& renderer) {
    const std::string lower = lowerCase(renderer);
    for (const char* name : {"llvmpipe", "softpipe", "swrast", "software", "swiftshader", "swr"})
        if (lower.find(name) != std::string::npos) return true;
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
