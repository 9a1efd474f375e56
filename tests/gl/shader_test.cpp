#include "gl_test.h"

#include <set>

#include "render/gl/gl_resources.h"
#include "render/gl/shader_program.h"
#include "tf/opacity.h"

using namespace pellucid;
using namespace pellucid::gl;
using namespace pellucid::testing;

TEST_CASE("every permutation of every shader compiles", "[gl]") {
    if (!haveGl()) return;
    struct Program {
        std::vector<std::string> files;
        std::vector<std::vector<std::string>> permutations;
    };
    std::vector<std::vector<std::string>> marches, gathers, slabs, layers;
    for (const char* candidates : {"CANDIDATES 1", "CANDIDATES 4", "CANDIDATES 8"})
        for (const bool invalid : {false, true})
            for (const bool folded : {false, true}) {
                std::vector<std::string> defines{candidates};
                if (invalid) defines.push_back("HAS_INVALID");
                if (folded) defines.push_back("FOLDED");
                marches.push_back(defines);
                gathers.push_back(defines);
                gathers.back().insert(gathers.back().end(), {"SLOTS 4", "SEGMENTS 2"});
                if (candidates != std::string("CANDIDATES 1")) continue;
                gathers.push_back(defines);
                gathers.back().push_back("FIELD");
                slabs.push_back(defines);
                layers.push_back(gathers.back());
                layers.push_back(defines);
                layers.back().insert(layers.back().end(), {"SLOTS 4", "SEGMENTS 2", "CLIPPED"});
            }
    marches.push_back({"CANDIDATES 1", "CLIPPED"});
    gathers.push_back({"CANDIDATES 1", "CLIPPED", "FIELD"});
    std::vector<std::vector<std::string>> casts;
    for (int mode = 0; mode < 5; ++mode)
        for (const bool invalid : {false, true})
            for (const bool bricks : {false, true}) {
                std::vector<std::string> defines{"MODE " + std::to_string(mode), "BLOCK_SHIFT 2"};
                if (invalid) defines.push_back("HAS_INVALID");
                if (bricks) defines.push_back("BRICKS");
                casts.push_back(defines);
                if (mode != 0 && mode != 4) continue;
                for (const char* part : {"LIGHT", "OCCLUSION", "GRADIENT_OPACITY"}) { // one more each time
                    defines.push_back(part);
                    casts.push_back(defines);
                }
            }
    const std::vector<Program> programs{{{"composite.vert", "raycast.frag"}, casts},
                                        {{"composite.vert", "composite.frag"}, {{}}},
                                        {{"composite.vert", "vision.frag"}, {{}}},
                                        {{"composite.vert", "slices_depth.frag"}, slabs},
                                        {{"slices_gather.comp"}, layers},
                                        {{"visibility_march.comp"}, marches},
                                        {{"visibility_gather.comp"}, gathers},
                                        {{"visibility_reduce.comp"}, {{}}}};
    std::set<std::string> stages;
    gl::HeadlessContext context;
    for (const Program& program : programs) {
        stages.insert(program.files.begin(), program.files.end());
        for (const auto& defines : program.permutations) {
            CAPTURE(program.files, defines);
            CHECK_NOTHROW(context.run([&] { makeProgram(program.files, defines); }));
        }
    }
    std::size_t known = 0;
    for (const EmbeddedShader& shader : embeddedShaders())
        if (std::string(shader.name).find(".glsl") == std::string::npos) ++known;
    CHECK(stages.size() == known); // a new shader belongs into the list above
}

TEST_CASE("a shader that does not compile says where", "[gl]") {
    if (!haveGl()) return;
    const auto lookup = [](const std::string& name) -> std::optional<std::string> {
        if (name == "bad.comp") return "layout(local_size_x = 1) in;\n#include \"part.glsl\"\nvoid main() { f(); }\n";
        if (name == "part.glsl") return "// fine\nvoid f() { undeclared = 1; }\n";
        return {};
    };
    gl::HeadlessContext context;
    try {
        context.run([&] { makeProgram({"bad.comp"}, {}, lookup); });
        FAIL("expected an error");
    } catch (const Error& error) {
        CHECK(error.problem().find("part.glsl:2:") != std::string::npos);
        CHECK(error.where() == "bad.comp");
    }
}

TEST_CASE("opacity.glsl and opacity.h are the same formula", "[gl]") {
    if (!haveGl()) return;
    // From the caps down to steps where 1 − exp(−x) would lose all its digits.
    std::vector<float> input; // pairs: optical depth, steps
    for (const double alpha : {0.0, 1e-6, 1e-3, 0.1, 0.5, 0.9, 0.999, 1.0})
        for (const double steps : {1e-4, 0.01, 0.25, 1.0, 3.0}) {
            input.push_back(static_cast<float>(opticalDepthOfOpacity(alpha)));
            input.push_back(static_cast<float>(steps));
        }
    const std::size_t count = input.size() / 2;
    const auto lookup = [](const std::string& name) -> std::optional<std::string> {
        if (name != "probe.comp") return embeddedShaderSource(name);
        return "#include \"include/opacity.glsl\"\n"
               "layout(local_size_x = 1) in;\n"
               "layout(binding = 0, std430) readonly buffer In { vec2 i_pair[]; };\n"
               "layout(binding = 1, std430) writeonly buffer Out { float o_opacity[]; };\n"
               "void main() { uint i = gl_GlobalInvocationID.x; o_opacity[i] = opacityOfStep(i_pair[i].x, "
               "i_pair[i].y); }\n";
    };
    std::vector<float> output(count);
    gl::HeadlessContext context;
    context.run([&] {
        const auto program = makeProgram({"probe.comp"}, {}, lookup);
        const auto in =
            makeBuffer(GL_SHADER_STORAGE_BUFFER, input.size() * sizeof(float), input.data(), GL_STATIC_DRAW, "test");
        const auto out = makeBuffer(GL_SHADER_STORAGE_BUFFER, count * sizeof(float), nullptr, GL_STREAM_READ, "test");
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 0, in.name.id());
        glBindBufferBase(GL_SHADER_STORAGE_BUFFER, 1, out.name.id());
        glUseProgram(program.id());
        glDispatchCompute(static_cast<GLuint>(count), 1, 1);
        glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
        glBindBuffer(GL_SHADER_STORAGE_BUFFER, out.name.id());
        glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, 0, static_cast<GLsizeiptr>(count * sizeof(float)), output.data());
        throwOnGlError("probing opacity");
    });
    for (std::size_t i = 0; i < count; ++i) {
        const double alpha = -std::expm1(-static_cast<double>(input[2 * i]));
        const double expected = opacityOfStep(alpha, static_cast<double>(input[2 * i + 1]));
        CAPTURE(input[2 * i], input[2 * i + 1]);
        CHECK(static_cast<double>(output[i]) == Approx(expected).epsilon(2e-5).margin(1e-12));
    }
}
