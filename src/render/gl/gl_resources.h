// Textures, framebuffers and buffers with their sizes, and how GL's errors become ours.
#pragma once

#include <cstddef>
#include <string>

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

#include "base/error.h"
#include "render/gl/gl_object.h"

namespace pellucid::gl {

/// The device has no room for what was asked for: something smaller may do.
class OutOfMemory : public Error {
public:
    using Error::Error;
};

/// Refuses textures and buffers of more than this many bytes from now on, in every context, as a device does that has
/// no more memory: for tests. Infinite at first.
void limitAllocations(double bytes);

/// Throws Error where GL has recorded one since the last call: `doing` says what was attempted ("drawing the slices").
void throwOnGlError(const std::string& doing);

int glInteger(GLenum parameter);

/// Immutable storage, one level, clamped to the edge.
struct Texture2d {
    TextureName name;
    glm::ivec2 size{0, 0};
    GLenum format = 0; ///< sized internal format
};
struct Texture3d {
    TextureName name;
    glm::ivec3 size{0, 0, 0};
    GLenum format = 0;
};
/// `filter` is GL_NEAREST or GL_LINEAR; `what` names the content in errors. Throw Error: too large; OutOfMemory.
Texture2d makeTexture2d(glm::ivec2 size, GLenum format, GLenum filter, const std::string& what);
Texture3d makeTexture3d(glm::ivec3 size, GLenum format, GLenum filter, const std::string& what);

/// Fills the whole texture with pixels that lie in memory row after row, without gaps. `doing` as throwOnGlError()
/// takes it.
void upload(const Texture2d& texture, GLenum format, GLenum type, const void* pixels, const std::string& doing);
void upload(const Texture3d& texture, GLenum format, GLenum type, const void* pixels, const std::string& doing);

/// A framebuffer with one colour texture.
struct ColorTarget {
    Texture2d color;
    FramebufferName framebuffer;
};
ColorTarget makeColorTarget(glm::ivec2 size, GLenum format, GLenum filter, const std::string& what);

struct Buffer {
    BufferName name;
    std::size_t bytes = 0;
};
Buffer makeBuffer(GLenum target, std::size_t bytes, const void* data, GLenum usage, const std::string& what);

void bindTexture(int unit, GLenum target, const TextureName& name);

} // namespace pellucid::gl
