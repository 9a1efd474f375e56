#include "render/gl/shader_program.h"
#include <cstring>

#include "base/error.h"
#include "render/gl/gl_resources.h"

namespace pellucid::gl {

namespace {

GLenum stageOf(const std::string& file) {
    const std::string suffix = file.substr(file.rfind('.') + 1);
    if (suffix == "vert") return GL_VERTEX_SHADER;
    if (suffix == "frag") return GL_FRAGMENT_SHADER;
    if (suffix == "comp") return GL_COMPUTE_SHADER;
    throw Error("a shader file without a stage", file, "name it .vert, .frag or .comp");
}

struct ShaderName {
    explicit ShaderName(GLenum stage) : id(glCreateShader(stage)) {}
    ~ShaderName() { glDeleteShader(id); }
    ShaderName(const ShaderName&) = delete;
    ShaderName& operator=(const ShaderName&) = delete;
    GLuint id;
};

/// What a compiler or linker said; `read` has room for `length` characters.
template <class Read>
std::string logOf(GLint length, const Read& read) {
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    read(log.data());
    log.resize(std::strlen(log.c_str())); // drivers count the 0 at the end
    return log;
}

void compileInto(GLuint program, const std::string& file, const std::vector<std::string>& defines,
                 const ShaderLookup& lookup) {
    const ShaderSource source = expandShader(file, defines, lookup);
    const ShaderName shader(stageOf(file));
    const char* text = source.text.c_str();
    glShaderSource(shader.id, 1, &text, nullptr);
    glCompileShader(shader.id);
    GLint done = GL_FALSE, length = 0;
    glGetShaderiv(shader.id, GL_COMPILE_STATUS, &done);
    if (done != GL_TRUE) {
        glGetShaderiv(shader.id, GL_INFO_LOG_LENGTH, &length);
        const std::string log =
            logOf(length, [&](char* into) { glGetShaderInfoLog(shader.id, length, nullptr, into); });
        throw Error("a shader does not compile: " + mapShaderLog(log, source), file,
                    "report this with your driver's version", Remedy::OtherEngine);
    }
    glAttachShader(program, shader.id);
}

} // namespace

ProgramName makeProgram(const std::vector<std::string>& files, const std::vector<std::string>& defines,
                        const ShaderLookup& lookup) {
    ProgramName program = ProgramName::make();
    for (const std::string& file : files) compileInto(program.id(), file, defines, lookup);
    glLinkProgram(program.id());
    GLint done = GL_FALSE, length = 0;
    glGetProgramiv(program.id(), GL_LINK_STATUS, &done);
    if (done != GL_TRUE) {
        glGetProgramiv(program.id(), GL_INFO_LOG_LENGTH, &length);
        const std::string log =
            logOf(length, [&](char* into) { glGetProgramInfoLog(program.id(), length, nullptr, into); });
        throw Error("a shader program does not link: " + log, files.front(), "report this with your driver's version",
                    Remedy::OtherEngine);
    }
    return program;
}

void Program::setPlanes(GLint count, GLint first, const std::vector<VoxelPlane>& planes) const {
    set(count, static_cast<int>(planes.size()));
    for (std::size_t i = 0; i < planes.size(); ++i)
        set(first + static_cast<GLint>(i), glm::dvec4(planes[i].normal, planes[i].offset));
}

void requireGl43() {
    // Not epoxy's own questions: they look for EGL, which a machine that falls back to OSMesa may lack.
    const GLubyte* text = glGetString(GL_VERSION);
    if (text == nullptr) throw Error("no OpenGL context is current", "OpenGL", "", Remedy::OtherEngine);
    const std::string version = reinterpret_cast<const char*>(text);
    const bool desktop = version.rfind("OpenGL ES", 0) != 0;
    const int number = 10 * glInteger(GL_MAJOR_VERSION) + glInteger(GL_MINOR_VERSION);
    if (!desktop || number < 43)
        throw Error("this is OpenGL \"" + version + "\", 4.3 is needed", "OpenGL", "update the graphics driver",
                    Remedy::OtherEngine);
}

} // namespace pellucid::gl
