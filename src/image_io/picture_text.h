// What a picture's file says of the picture.
#pragma once

#include <string>

namespace pellucid {

/// Empty: not said.
struct PictureText {
    std::string software;    ///< "Pellucid 1.0.0"
    std::string description; ///< a caption
    std::string command;     ///< a line that draws the picture again
    std::string session;     ///< a session as JSON, paths in it relative to the folder of the picture
};

// Under which keywords PNG and EXR files have them. The first two are those of the PNG format, and of EXR's habits.
inline constexpr const char* kSoftwareKeyword = "Software";
inline constexpr const char* kDescriptionKeyword = "Description";
inline constexpr const char* kCommandKeyword = "pellucid:command";
inline constexpr const char* kSessionKeyword = "pellucid:session";

} // namespace pellucid
