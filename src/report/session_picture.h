// Pictures that carry the session that they show: what their files say of them, and the way back.
#pragma once

#include <string>

#include "image_io/picture_text.h"
#include "session/scene.h"
#include "session/session_json.h"

namespace pellucid {

/// The session as a picture at `path` carries it: that of the scene with the camera that it is seen from, as a session
/// file in the picture's folder would have it, data files by names relative to that folder. Empty where the name of a
/// data file is no UTF-8 text, which JSON cannot hold.
std::string sessionText(const Scene& scene, const std::string& path);

/// Whether the file is a PNG picture that carries a session. False also where it cannot be read.
bool carriesSession(const std::string& path);
/// The session in a session file, or in a picture that carries one. Throws as readSession() does; FileError for a PNG
/// picture that is damaged or carries none.
SessionFile readSessionOrPicture(const std::string& path);

} // namespace pellucid
