// The one place where OpenGL is included; only src/render/gl may include this file.
// epoxy finds each function in whatever context is current when it is first called, so that the same code runs in the
// context of the window and in one of our own. We keep to what GL 4.3 core has.
#pragma once

#include <epoxy/gl.h>
