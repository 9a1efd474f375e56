// A linked program made of embedded shader files. Uniform locations and bindings are written in the shaders; the C++
// class of each shader is their only other user.
#pragma once

#include <string>
#include <vector>

#include "render/gl/gl_object.h"
#include "render/gl/shader_source.h"

namespace pellucid::gl {

/// `files` are names that `lookup` knows, below shaders/; the suffix tells the stage (.vert, .frag, .comp). Throws
/// Error with the compiler's message at the original file and line.
ProgramName makeProgram(const std::vector<std::string>& files, const std::vector<std::string>& defines = {},
                        const ShaderLookup& lookup = embeddedShaderSource);

/// Throws Error unless the current context is OpenGL 4.3 or later.
void requireGl43();

} // namespace pellucid::gl
