// Every OpenGL and EGL function that src/render/gl and its tests call, for loaders that must find each by name
// (osmesa.cpp, gl_loader.cpp). A test compares these lists with the sources.
#pragma once

// clang-format off
#define PELLUCID_GL_FUNCTIONS(X)                                                                                      \
    X(glActiveTexture) X(glAttachShader) X(glBindBuffer) X(glBindBufferBase) X(glBindFramebuffer)                     \
    X(glBindImageTexture) X(glBindTexture) X(glBindVertexArray) X(glBlendEquation) X(glBlendFunc) X(glBufferData)     \
    X(glBufferSubData) X(glCheckFramebufferStatus) X(glClear) X(glClearBufferfv) X(glClearColor) X(glColorMask)       \
    X(glCompileShader) X(glCopyTexSubImage3D) X(glCreateProgram) X(glCreateShader) X(glDebugMessageCallback)          \
    X(glDeleteBuffers)                                                                                                \
    X(glDeleteFramebuffers) X(glDeleteProgram) X(glDeleteShader) X(glDeleteTextures) X(glDeleteVertexArrays)          \
    X(glDisable) X(glDispatchCompute) X(glDrawArrays) X(glEnable) X(glFinish) X(glFramebufferTexture2D)               \
    X(glGenBuffers) X(glGenFramebuffers) X(glGenTextures) X(glGenVertexArrays) X(glGetBufferSubData) X(glGetError)    \
    X(glGetIntegerv) X(glGetProgramInfoLog) X(glGetProgramiv) X(glGetShaderInfoLog) X(glGetShaderiv) X(glGetString)   \
    X(glIsEnabled) X(glIsShader) X(glLinkProgram) X(glMapBufferRange) X(glMemoryBarrier) X(glPixelStorei)             \
    X(glProgramUniform1f) X(glProgramUniform1i) X(glProgramUniform2fv) X(glProgramUniform2iv) X(glProgramUniform3fv)  \
    X(glProgramUniform3iv) X(glProgramUniform4fv) X(glProgramUniform4iv) X(glProgramUniformMatrix3fv) X(glReadPixels) \
    X(glScissor)                                                                                                      \
    X(glShaderSource) X(glTexParameteri) X(glTexStorage2D) X(glTexStorage3D) X(glTexSubImage2D) X(glTexSubImage3D)    \
    X(glUnmapBuffer) X(glUseProgram) X(glViewport)
#define PELLUCID_EGL_FUNCTIONS(X)                                                                                     \
    X(eglBindAPI) X(eglChooseConfig) X(eglCreateContext) X(eglDestroyContext) X(eglGetCurrentContext)                 \
    X(eglGetDisplay) X(eglGetPlatformDisplayEXT) X(eglInitialize) X(eglMakeCurrent) X(eglQueryDeviceStringEXT)        \
    X(eglQueryDevicesEXT) X(eglQueryString) X(eglReleaseThread)
// clang-format on
