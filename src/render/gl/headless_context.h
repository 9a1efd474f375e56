// An OpenGL context without a window, for the command line, the tests and the engines.
#pragma once

#include <condition_variable>
#include <exception>
#include <functional>
#include <memory>
#include <mutex>
#include <thread>

#include "render/gl/gl_engines.h"

namespace pellucid::gl {

/// OpenGL 4.3 core or later, on a thread of its own where it stays current for as long as it lives. So any thread may
/// ask it to work, and no caller's own context (Qt's, say, be it EGL's or GLX's) is ever touched.
class HeadlessContext {
public:
    /// Tries, in this order: EGL on a real GPU's device, EGL surfaceless (Mesa), any other EGL device, EGL's default
    /// display, OSMesa (and that alone where the environment says PELLUCID_GL_PLATFORM=osmesa). Throws Error that names
    /// each attempt where none works.
    HeadlessContext();
    ~HeadlessContext();
    HeadlessContext(const HeadlessContext&) = delete;
    HeadlessContext& operator=(const HeadlessContext&) = delete;

    const GlInfo& info() const { return m_info; }

    /// Runs `work` where the context is current, and waits; what it throws is thrown here. One caller at a time; others
    /// wait. Not to be called from inside `work`.
    void run(const std::function<void()>& work);

private:
    void threadMain();

    GlInfo m_info;
    std::mutex m_callers; ///< held by the caller whose work is being done
    std::mutex m_mutex;   ///< guards what follows
    std::condition_variable m_changed;
    const std::function<void()>* m_work = nullptr;
    std::exception_ptr m_error;
    bool m_ready = false, m_quit = false;
    std::thread m_thread; ///< last: starts when all else is there
};

/// An object of GL's world that lives and dies where the context is current.
template <class T>
class InContext {
public:
    InContext() : m_context(std::make_unique<HeadlessContext>()) {}
    ~InContext() {
        m_context->run([&] { m_object.reset(); });
    }
    InContext(const InContext&) = delete;
    InContext& operator=(const InContext&) = delete;

    /// work(T&) in the context; before the first call `make` builds the object there.
    void emplace(const std::function<std::unique_ptr<T>()>& make) {
        m_context->run([&] { m_object = make(); });
    }
    template <class Work>
    void run(Work&& work) {
        m_context->run([&] { work(*m_object); });
    }
    const GlInfo& info() const { return m_context->info(); }

private:
    std::unique_ptr<HeadlessContext> m_context;
    std::unique_ptr<T> m_object;
};

} // namespace pellucid::gl
