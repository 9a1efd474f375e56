// Pictures as a film, by a program that people have installed: ffmpeg.
#pragma once

#include <stop_token>
#include <string>
#include <vector>

namespace pellucid {

/// A new folder beside a file, which goes with all that is in it when this does.
class ScratchFolder {
public:
    explicit ScratchFolder(const std::string& path);
    ~ScratchFolder();
    ScratchFolder(const ScratchFolder&) = delete;
    ScratchFolder& operator=(const ScratchFolder&) = delete;

    const std::string& path() const { return m_folder; }
    std::string file(const char* name) const { return m_folder + "/" + name; }

private:
    std::string m_folder;
};

bool isMovie(const std::string& path); ///< whether it ends in .mp4
bool hasMovieWriter();                 ///< whether there is an ffmpeg in PATH

/// H.264 in `path`, `framesPerSecond` pictures a second; a line is added to pictures of odd sizes. The film is whole or
/// absent. Throws Error with what ffmpeg says where it fails, Cancelled.
void writeMovie(const std::vector<std::string>& pictures, double framesPerSecond, const std::string& path,
                const std::stop_token& stop);

} // namespace pellucid
