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

/// What a film is written as, by the suffix of its name.
enum class FilmFile {
    Pictures,   ///< a folder of PNG files
    Mp4,        ///< H.264, by ffmpeg
    WebM,       ///< VP9, by ffmpeg
    Gif,        ///< 256 colours, by ffmpeg
    AnimatedPng ///< .apng, .png: lossless, by our own code
};
FilmFile filmFileOf(const std::string& path);
/// Throws UsageError where the name ends as a film that is not written: it would become a folder.
void checkFilmSuffix(const std::string& path);
bool needsMovieWriter(FilmFile file);  ///< ffmpeg
bool isMovie(const std::string& path); ///< whether it ends in .mp4
bool hasMovieWriter();                 ///< whether there is an ffmpeg in PATH

/// A film of PNG files of one size in `path`, `framesPerSecond` pictures a second. To pictures of odd sizes MP4 and
/// WebM add a line; their colours are those of BT.709 in video range, and say so. The same pictures give the same bytes
/// with the same ffmpeg. The film is whole or absent. Throws Error with what ffmpeg says where it fails, FileError,
/// Cancelled.
void writeMovie(const std::vector<std::string>& pictures, double framesPerSecond, const std::string& path,
                const std::stop_token& stop);

} // namespace pellucid
