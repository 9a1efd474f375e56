// Shader files: how includes are expanded, and how a compiler's message finds its way back to the file. Pure functions
// with an injected lookup, so that they are tested without a context.
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

namespace pellucid::gl {

/// One file of shaders/, compiled into the program.
struct EmbeddedShader {
    const char* name; ///< path below shaders/, "include/opacity.glsl"
    const char* source;
};
const std::vector<EmbeddedShader>& embeddedShaders();

/// Source of a file by name; empty where there is none.
using ShaderLookup = std::function<std::optional<std::string>(const std::string& name)>;
std::optional<std::string> embeddedShaderSource(const std::string& name);

/// Source ready for the compiler, and where each of its lines came from.
struct ShaderSource {
    struct Origin {
        std::string file;
        int line = 0; ///< from 1; 0: written by us (#version, #define)
    };
    std::string text;
    std::vector<Origin> lines; ///< line i + 1 of text
};

/// `#version 430 core`, one `#define` per entry of `defines` ("NAME" or "NAME VALUE"), then the file with every
/// `#include "name"` replaced by that file, once. Throws Error naming file and line: unknown file, malformed include.
ShaderSource expandShader(const std::string& name, const std::vector<std::string>& defines,
                          const ShaderLookup& lookup = embeddedShaderSource);

/// A compiler's log with "0:41(7):" (Mesa), "0(41) :" (NVIDIA), "ERROR: 0:41:" (others) written as "file:line:".
std::string mapShaderLog(const std::string& log, const ShaderSource& source);

} // namespace pellucid::gl
