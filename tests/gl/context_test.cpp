#include "gl_test.h"

#include <thread>

#include <epoxy/egl.h>

#include "engines/engines.h"
#include "render/gl/gl_engines.h"
#include "render/gl/gl_resources.h"

using namespace pellucid;
using namespace pellucid::testing;

TEST_CASE("a headless context is OpenGL 4.3 or later and says what it is", "[gl]") {
    if (!haveGl()) return;
    gl::HeadlessContext context;
    CHECK_FALSE(context.info().renderer.empty());
    CHECK_FALSE(context.info().platform.empty());
    int version = 0;
    context.run([&] { version = 10 * gl::glInteger(GL_MAJOR_VERSION) + gl::glInteger(GL_MINOR_VERSION); });
    CHECK(version >= 43);
    const auto probed = probeGl();
    REQUIRE(probed);
    CHECK(probed->renderer == context.info().renderer);
}

TEST_CASE("any thread may use a context, and errors come back to the caller", "[gl]") {
    if (!haveGl()) return;
    gl::HeadlessContext context;
    GLuint name = 0;
    std::thread other([&] { context.run([&] { name = glCreateShader(GL_VERTEX_SHADER); }); });
    other.join();
    bool isShader = false;
    context.run([&] {
        isShader = glIsShader(name) == GL_TRUE;
        glDeleteShader(name);
    });
    CHECK(isShader);
    CHECK_THROWS_AS(context.run([] { throw Error("what", "where", "do"); }), Error);
    CHECK_THROWS_AS(context.run([] { throw Cancelled{}; }), Cancelled);
    bool ran = false;
    context.run([&] { ran = true; }); // still alive
    CHECK(ran);
}

TEST_CASE("the caller's own context stays current", "[gl]") {
    if (!haveGl()) return;
    if (probeGl()->platform == "OSMesa") {
        std::cout << "SKIPPED: without EGL the caller has no context\n";
        return;
    }
    const EGLDisplay display = eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr);
    if (eglInitialize(display, nullptr, nullptr) != EGL_TRUE || eglBindAPI(EGL_OPENGL_API) != EGL_TRUE) {
        std::cout << "SKIPPED: no surfaceless display for a context of the caller's\n";
        return;
    }
    const EGLContext own = eglCreateContext(display, EGL_NO_CONFIG_KHR, EGL_NO_CONTEXT, nullptr);
    REQUIRE(own != EGL_NO_CONTEXT);
    REQUIRE(eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, own) == EGL_TRUE);
    {
        const auto volume = noise({6, 6, 6}, {1, 1, 1}, 1);
        const auto engine = makeGlEngine(volume);
        engine->field(orthographic(volume->geometry(), {0, 1, 0}, 10), constantOpacity(0.5));
        CHECK(eglGetCurrentContext() == own);
        const auto renderer = makeGlRenderer(volume);
        renderer->render(orthographic(volume->geometry(), {0, 1, 0}, 10), constantOpacity(0.5), {});
        CHECK(eglGetCurrentContext() == own);
    }
    CHECK(eglGetCurrentContext() == own);
    eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(display, own);
}

TEST_CASE("engines are chosen by name", "[gl]") {
    CHECK(fromName<EngineChoice>("auto") == EngineChoice::Auto);
    CHECK(fromName<EngineChoice>("gl") == EngineChoice::Gl);
    CHECK(fromName<EngineChoice>("cpu") == EngineChoice::Cpu);
    CHECK(fromName<EngineChoice>("slices") == EngineChoice::Slices);
    CHECK(fromName<EngineChoice>("reference") == EngineChoice::Reference);
    CHECK_THROWS_AS(fromName<EngineChoice>("opengl"), UsageError);

    const auto volume = noise({4, 4, 4}, {1, 1, 1}, 1);
    CHECK(makeEngine(EngineChoice::Cpu, volume)->name() == "cpu");
    CHECK(makeEngine(EngineChoice::Reference, volume)->name() == "reference");
    CHECK(makeRenderer(EngineChoice::Reference, volume)->name() == "cpu");
    const auto info = probeGl();
    const std::string best = info && !info->software ? "gl" : "cpu";
    CHECK(makeEngine(EngineChoice::Auto, volume)->name() == best);
    CHECK(makeRenderer(EngineChoice::Auto, volume)->name() == best);
    if (!haveGl()) return;
    CHECK(makeEngine(EngineChoice::Gl, volume)->name() == "gl");
    CHECK(makeRenderer(EngineChoice::Gl, volume)->name() == "gl");
    CHECK(makeEngine(EngineChoice::Slices, volume)->name() == "slices");
    CHECK(makeRenderer(EngineChoice::Slices, volume)->name() == "gl");
}
