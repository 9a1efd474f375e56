#include "render/gl/gl_resources.h"

#include <atomic>
#include <limits>

namespace pellucid::gl {

namespace {

const char* errorName(GLenum error) {
    switch (error) {
    case GL_INVALID_ENUM:
        return "GL_INVALID_ENUM";
    case GL_INVALID_VALUE:
        return "GL_INVALID_VALUE";
    case GL_INVALID_OPERATION:
        return "GL_INVALID_OPERATION";
    case GL_INVALID_FRAMEBUFFER_OPERATION:
        return "GL_INVALID_FRAMEBUFFER_OPERATION";
    case GL_OUT_OF_MEMORY:
        return "GL_OUT_OF_MEMORY";
    default:
        return "unknown error";
    }
}

const char* kOutOfMemory = "the graphics device is out of memory while ";

std::atomic<double> allocationLimit = std::numeric_limits<double>::infinity();

void throwIfTooMuch(double bytes, const std::string& what) {
    if (bytes > allocationLimit)
        throw OutOfMemory(kOutOfMemory + ("making room for " + what), "OpenGL", "", Remedy::OtherEngine);
}

double bytesPerTexel(GLenum format) {
    switch (format) {
    case GL_R8:
    case GL_R8UI:
        return 1;
    case GL_R16:
        return 2;
    case GL_RGBA32F:
    case GL_RGBA32UI:
        return 16;
    default:
        return 4;
    }
}

void checkSize(int largest, GLenum limitName, const std::string& what) {
    const int limit = glInteger(limitName);
    if (largest > limit)
        throw Error(what + " needs a texture of " + std::to_string(largest) + " along one axis, the device takes " +
                        std::to_string(limit),
                    "OpenGL", "", Remedy::OtherEngine);
}

void clampToEdge(GLenum target, GLenum filter) {
    const auto set = [&](GLenum parameter, GLenum value) {
        glTexParameteri(target, parameter, static_cast<GLint>(value));
    };
    set(GL_TEXTURE_MIN_FILTER, filter);
    set(GL_TEXTURE_MAG_FILTER, filter);
    set(GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    set(GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    if (target == GL_TEXTURE_3D) set(GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
}

} // namespace

void limitAllocations(double bytes) { allocationLimit = bytes; }

void throwOnGlError(const std::string& doing) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) return;
    // A lost context reports errors for ever: take a bounded number away.
    for (int i = 0; i < 16 && glGetError() != GL_NO_ERROR; ++i) {
    }
    if (error == GL_OUT_OF_MEMORY) throw OutOfMemory(kOutOfMemory + doing, "OpenGL", "", Remedy::OtherEngine);
    throw Error(std::string("OpenGL reports ") + errorName(error) + " while " + doing, "OpenGL", "",
                Remedy::OtherEngine);
}

int glInteger(GLenum parameter) {
    GLint value = 0;
    glGetIntegerv(parameter, &value);
    return value;
}

Texture2d makeTexture2d(glm::ivec2 size, GLenum format, GLenum filter, const std::string& what) {
    checkSize(std::max(size.x, size.y), GL_MAX_TEXTURE_SIZE, what);
    throwIfTooMuch(bytesPerTexel(format) * size.x * size.y, what);
    throwOnGlError("preparing " + what);
    Texture2d texture{TextureName::make(), size, format};
    glBindTexture(GL_TEXTURE_2D, texture.name.id());
    glTexStorage2D(GL_TEXTURE_2D, 1, format, size.x, size.y);
    clampToEdge(GL_TEXTURE_2D, filter);
    glBindTexture(GL_TEXTURE_2D, 0);
    throwOnGlError("making room for " + what);
    return texture;
}

Texture3d makeTexture3d(glm::ivec3 size, GLenum format, GLenum filter, const std::string& what) {
    checkSize(std::max(size.x, std::max(size.y, size.z)), GL_MAX_3D_TEXTURE_SIZE, what);
    throwIfTooMuch(bytesPerTexel(format) * size.x * size.y * size.z, what);
    throwOnGlError("preparing " + what);
    Texture3d texture{TextureName::make(), size, format};
    glBindTexture(GL_TEXTURE_3D, texture.name.id());
    glTexStorage3D(GL_TEXTURE_3D, 1, format, size.x, size.y, size.z);
    clampToEdge(GL_TEXTURE_3D, filter);
    glBindTexture(GL_TEXTURE_3D, 0);
    throwOnGlError("making room for " + what);
    return texture;
}

ColorTarget makeColorTarget(glm::ivec2 size, GLenum format, GLenum filter, const std::string& what) {
    ColorTarget target{makeTexture2d(size, format, filter, what), FramebufferName::make()};
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer.id());
    glFramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, target.color.name.id(), 0);
    const GLenum status = glCheckFramebufferStatus(GL_FRAMEBUFFER);
    glBindFramebuffer(GL_FRAMEBUFFER, 0);
    if (status != GL_FRAMEBUFFER_COMPLETE)
        throw Error("the device cannot draw into a float image (status " + std::to_string(status) + ")", "OpenGL", "",
                    Remedy::OtherEngine);
    throwOnGlError("making the framebuffer for " + what);
    return target;
}

Buffer makeBuffer(GLenum target, std::size_t bytes, const void* data, GLenum usage, const std::string& what) {
    throwIfTooMuch(static_cast<double>(bytes), what);
    throwOnGlError("preparing " + what);
    Buffer buffer{BufferName::make(), bytes};
    glBindBuffer(target, buffer.name.id());
    glBufferData(target, static_cast<GLsizeiptr>(bytes), data, usage);
    glBindBuffer(target, 0);
    throwOnGlError("making room for " + what);
    return buffer;
}

void bindTexture(int unit, GLenum target, const TextureName& name) {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(target, name.id());
}

} // namespace pellucid::gl
