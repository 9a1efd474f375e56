// A linked program made of embedded shader files. Uniform locations and bindings are written in the shaders; the C++
// class of each shader is their only other user.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <glm/gtc/type_ptr.hpp>

#include "render/clipping.h"
#include "render/gl/gl_object.h"
#include "render/gl/shader_source.h"

namespace pellucid::gl {

/// `files` are names that `lookup` knows, below shaders/; the suffix tells the stage (.vert, .frag, .comp). Throws
/// Error with the compiler's message at the original file and line.
ProgramName makeProgram(const std::vector<std::string>& files, const std::vector<std::string>& defines = {},
                        const ShaderLookup& lookup = embeddedShaderSource);

/// A program whose uniforms are set by their locations, in single precision.
class Program {
public:
    explicit Program(const std::vector<std::string>& files, const std::vector<std::string>& defines = {})
        : m_name(makeProgram(files, defines)), m_id(m_name.id()) {}

    void use() const { glUseProgram(m_id); }
    void set(GLint at, int v) const { glProgramUniform1i(m_id, at, v); }
    void set(GLint at, double v) const { glProgramUniform1f(m_id, at, static_cast<float>(v)); }
    void set(GLint at, const glm::ivec2& v) const { glProgramUniform2iv(m_id, at, 1, glm::value_ptr(v)); }
    void set(GLint at, const glm::ivec3& v) const { glProgramUniform3iv(m_id, at, 1, glm::value_ptr(v)); }
    void set(GLint at, const glm::ivec4& v) const { glProgramUniform4iv(m_id, at, 1, glm::value_ptr(v)); }
    void set(GLint at, const glm::dvec2& v) const { glProgramUniform2fv(m_id, at, 1, glm::value_ptr(glm::vec2(v))); }
    void set(GLint at, const glm::dvec3& v) const { glProgramUniform3fv(m_id, at, 1, glm::value_ptr(glm::vec3(v))); }
    void set(GLint at, const glm::dvec4& v) const { glProgramUniform4fv(m_id, at, 1, glm::value_ptr(glm::vec4(v))); }
    void set(GLint at, const glm::dmat3& m) const {
        glProgramUniformMatrix3fv(m_id, at, 1, GL_FALSE, glm::value_ptr(glm::mat3(m)));
    }
    /// (normal, offset) of each plane, from the location `first` on; their number at `count`.
    void setPlanes(GLint count, GLint first, const std::vector<VoxelPlane>& planes) const;

private:
    ProgramName m_name;
    GLuint m_id;
};

/// The permutations of a program, by their defines; each is compiled when it is first needed.
template <class P>
class Permutations {
public:
    const P& of(const std::vector<std::string>& defines) {
        std::unique_ptr<P>& program = m_programs[defines];
        if (!program) program = std::make_unique<P>(defines);
        return *program;
    }

private:
    std::map<std::vector<std::string>, std::unique_ptr<P>> m_programs;
};

/// Throws Error unless the current context is OpenGL 4.3 or later.
void requireGl43();

} // namespace pellucid::gl
