// A GL name that frees itself. The context it was made in must be current when it is made and when it dies.
#pragma once

#include <type_traits>
#include <utility>

#include "render/gl/gl.h"

namespace pellucid::gl {

/// Kind: static void create(GLuint&); static void destroy(GLuint).
template <class Kind>
class GlObject {
public:
    GlObject() noexcept = default; ///< empty, calls no GL
    static GlObject make() {
        GlObject object;
        Kind::create(object.m_id);
        return object;
    }
    GlObject(GlObject&& other) noexcept : m_id(std::exchange(other.m_id, 0)) {}
    GlObject& operator=(GlObject&& other) noexcept {
        std::swap(m_id, other.m_id);
        return *this;
    }
    ~GlObject() {
        if (m_id != 0) Kind::destroy(m_id);
    }
    GLuint id() const noexcept { return m_id; }
    explicit operator bool() const noexcept { return m_id != 0; }

private:
    GLuint m_id = 0;
};

struct TextureKind {
    static void create(GLuint& id) { glGenTextures(1, &id); }
    static void destroy(GLuint id) { glDeleteTextures(1, &id); }
};
struct FramebufferKind {
    static void create(GLuint& id) { glGenFramebuffers(1, &id); }
    static void destroy(GLuint id) { glDeleteFramebuffers(1, &id); }
};
struct BufferKind {
    static void create(GLuint& id) { glGenBuffers(1, &id); }
    static void destroy(GLuint id) { glDeleteBuffers(1, &id); }
};
struct VertexArrayKind {
    static void create(GLuint& id) { glGenVertexArrays(1, &id); }
    static void destroy(GLuint id) { glDeleteVertexArrays(1, &id); }
};
struct ProgramKind {
    static void create(GLuint& id) { id = glCreateProgram(); }
    static void destroy(GLuint id) { glDeleteProgram(id); }
};

using TextureName = GlObject<TextureKind>;
using FramebufferName = GlObject<FramebufferKind>;
using BufferName = GlObject<BufferKind>;
using VertexArrayName = GlObject<VertexArrayKind>;
using ProgramName = GlObject<ProgramKind>;

static_assert(!std::is_copy_constructible_v<TextureName>);

} // namespace pellucid::gl
