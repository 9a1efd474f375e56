#include "render/gl/vision_filter.h"

#include "render/gl/gl_resources.h"
#include "render/gl/shader_program.h"

namespace pellucid::gl {

struct VisionFilter::Impl {
    Program program{{"composite.vert", "vision.frag"}};
    VertexArrayName emptyArray = VertexArrayName::make(); ///< composite.vert needs no vertices
};

VisionFilter::VisionFilter() : m_impl(std::make_unique<Impl>()) {}
VisionFilter::~VisionFilter() = default;

void VisionFilter::draw(unsigned texture, int width, int height, const LightMatrix& vision, unsigned framebuffer) {
    glm::dmat3 matrix; // columns first
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            matrix[column][row] = vision[static_cast<std::size_t>(row)][static_cast<std::size_t>(column)];
    for (const GLenum test : {GL_BLEND, GL_DEPTH_TEST, GL_STENCIL_TEST, GL_SCISSOR_TEST, GL_CULL_FACE}) glDisable(test);
    glBindFramebuffer(GL_FRAMEBUFFER, framebuffer);
    glViewport(0, 0, width, height);
    m_impl->program.use();
    m_impl->program.set(0, matrix); // u_vision
    glActiveTexture(GL_TEXTURE0);
    glBindTexture(GL_TEXTURE_2D, texture);
    glBindVertexArray(m_impl->emptyArray.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glBindVertexArray(0);
    glBindTexture(GL_TEXTURE_2D, 0);
    glUseProgram(0);
    throwOnGlError("drawing the picture as another viewer sees it");
}

} // namespace pellucid::gl
