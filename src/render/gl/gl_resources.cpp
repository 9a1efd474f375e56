#include "render/gl/gl_resources.h"

#include <algorithm>
#include <atomic>
#include <limits>
#include <utility>

namespace pellucid::gl {

namespace {

const char* errorName(GLenum error) {
    static constexpr std::pair<GLenum, const char*> kNames[] = {
        {GL_INVALID_ENUM, "GL_INVALID_ENUM"},
        {GL_INVALID_VALUE, "GL_INVALID_VALUE"},
        {GL_INVALID_OPERATION, "GL_INVALID_OPERATION"},
        {GL_INVALID_FRAMEBUFFER_OPERATION, "GL_INVALID_FRAMEBUFFER_OPERATION"},
        {GL_OUT_OF_MEMORY, "GL_OUT_OF_MEMORY"}};
    for (const auto& [number, name] : kNames)
        if (error == number) return name;
    return "unknown error";
}

const char* kOutOfMemory = "the graphics device is out of memory while ";

std::atomic<double> allocationLimit = std::numeric_limits<double>::infinity();

void throwIfTooMuch(double bytes, const std::string& what) {
    if (bytes > allocationLimit)
        throw OutOfMemory(kOutOfMemory + ("making room for " + what), "OpenGL", "", Remedy::OtherEngine);
}

double bytesPerTexel(GLenum format) {
    if (format == GL_R8 || format == GL_R8UI) return 1;
    if (format == GL_R16) return 2;
    return format == GL_RGBA32F || format == GL_RGBA32UI ? 16 : 4;
}

/// A texture of two dimensions has size.z = 1.
TextureName makeTexture(GLenum target, const glm::ivec3& size, GLenum format, GLenum filter, const std::string& what) {
    const int limit = glInteger(target == GL_TEXTURE_3D ? GL_MAX_3D_TEXTURE_SIZE : GL_MAX_TEXTURE_SIZE);
    if (const int largest = std::max({size.x, size.y, size.z}); largest > limit)
        throw Error(what + " needs a texture of " + std::to_string(largest) + " along one axis, the device takes " +
                        std::to_string(limit),
                    "OpenGL", "", Remedy::OtherEngine);
    throwIfTooMuch(bytesPerTexel(format) * size.x * size.y * size.z, what);
    throwOnGlError("preparing " + what);
    TextureName name = TextureName::make();
    glBindTexture(target, name.id());
    if (target == GL_TEXTURE_3D)
        glTexStorage3D(target, 1, format, size.x, size.y, size.z);
    else
        glTexStorage2D(target, 1, format, size.x, size.y);
    const auto set = [&](GLenum parameter, GLenum value) {
        glTexParameteri(target, parameter, static_cast<GLint>(value));
    };
    set(GL_TEXTURE_MIN_FILTER, filter);
    set(GL_TEXTURE_MAG_FILTER, filter);
    set(GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    set(GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    if (target == GL_TEXTURE_3D) set(GL_TEXTURE_WRAP_R, GL_CLAMP_TO_EDGE);
    glBindTexture(target, 0);
    throwOnGlError("making room for " + what);
    return name;
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
    return {makeTexture(GL_TEXTURE_2D, {size, 1}, format, filter, what), size, format};
}

Texture3d makeTexture3d(glm::ivec3 size, GLenum format, GLenum filter, const std::string& what) {
    return {makeTexture(GL_TEXTURE_3D, size, format, filter, what), size, format};
}

void upload(const Texture2d& texture, GLenum format, GLenum type, const void* pixels, const std::string& doing) {
    glBindTexture(GL_TEXTURE_2D, texture.name.id());
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, texture.size.x, texture.size.y, format, type, pixels);
    glBindTexture(GL_TEXTURE_2D, 0);
    throwOnGlError(doing);
}

void upload(const Texture3d& texture, GLenum format, GLenum type, const void* pixels, const std::string& doing) {
    const glm::ivec3& size = texture.size;
    glBindTexture(GL_TEXTURE_3D, texture.name.id());
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexSubImage3D(GL_TEXTURE_3D, 0, 0, 0, 0, size.x, size.y, size.z, format, type, pixels);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glBindTexture(GL_TEXTURE_3D, 0);
    throwOnGlError(doing);
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
