// Films of a scene: which picture comes when, and the pictures as files.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "base/enum_names.h"
#include "base/job.h"
#include "base/setting.h"
#include "session/keyframes.h"
#include "session/scene.h"

namespace pellucid {

enum class FilmKind {
    Turntable, ///< once around the volume
    Series,    ///< each frame of the series, from the present view
    Views,     ///< from view to view
    Keys       ///< from key to key, see keyframes.h
};
template <>
inline constexpr auto kNamesOf<FilmKind> = enumNames("film", "turntable", "series", "views", "keyframes");

struct FilmSettings {
    FilmKind kind = FilmKind::Turntable;
    double seconds = 8;          ///< of a turntable, and of the way through all views
    double framesPerSecond = 25; ///< pictures
    double degrees = 360;        ///< that a turntable turns
    bool operator==(const FilmSettings&) const = default;
};
template <>
std::span<const Setting> settingsOf<FilmSettings>();

inline constexpr int kMostFilmPictures = 100'000;

/// A picture of a film.
struct FilmShot {
    int frame = 0; ///< of the series
    Camera camera;
    std::optional<double> time = {}; ///< s, of FilmKind::Keys: the keys say what is seen, and from where
};

/// Between two cameras of one projection, t from 0 to 1: the center goes straight from one to the other, the eye around
/// it, as far off as the geometric mean says; it starts and ends at rest.
Camera cameraBetween(const Camera& a, const Camera& b, double t);

/// The views that a text names, with semicolons between: "anterior; 30,20,1.5; present", as viewFromText() reads them;
/// "present" is the scene's own. Throws UsageError without a place, also for fewer than two.
std::vector<Camera> viewsOfText(const std::string& text, const Scene& scene);

/// What the film shows. A turntable turns about the axis of the world that is nearest to the picture's upright one, and
/// ends one picture before it is where it began, so that the film can be repeated. `views` count for FilmKind::Views
/// alone. Throws UsageError without a place: of a series where there is none, of more than kMostFilmPictures.
std::vector<FilmShot> shotsOf(const FilmSettings& settings, const std::vector<Camera>& views, const Scene& scene);
/// From the first key to the last, both included where their distance is a number of whole pictures. Throws likewise,
/// and without keys.
std::vector<FilmShot> shotsOf(const Keyframes& keys, double framesPerSecond, const Geometry& geometry);

/// How many these are, `seconds` from the first key to the last.
double picturesOf(double seconds, double framesPerSecond);

struct FilmTask {
    Scene scene;
    std::vector<FilmShot> shots = {};
    int width = 1280, height = 720; ///< pixels
    double framesPerSecond = 25;
    AnnotationChoice around = AnnotationChoice::none(); ///< what stands around each picture
    /// A film (FilmFile), or a folder, new or not: it gets picture_00000.png …
    std::string path = {};
    Keyframes keys = {}; ///< of shots that have a time
    /// Pictures of this film that were drawn before it was stopped are taken as they are.
    bool resume = false;
};

struct FilmResult {
    int pictures = 0;
    int kept = 0;                        ///< of these that were there already
    std::vector<std::string> passedOver; ///< frames that could not be read: "frame 3: …"
};

/// What can be told before any work: throws UsageError as checkFilmSuffix() does, and Error where a film is wanted and
/// no ffmpeg is there, where the session shows a field in the place of the data, for a size that is none, and to resume
/// where another film was begun.
void checkFilm(const FilmTask& task);
std::string pictureName(int picture);                            ///< "picture_00012.png"
std::string pictureFileOf(const std::string& path, int picture); ///< that in the folder `path`
/// Where the pictures lie while the film is drawn: "F.mp4.pictures" beside a film, else the folder itself.
std::string picturesFolderOf(const std::string& path);

/// A film that was stopped before it was whole.
struct UnfinishedFilm {
    int pictures = 0;      ///< that were drawn
    bool isThisOne = true; ///< and not another one, which has the same name
};
/// Empty: none was stopped there.
std::optional<UnfinishedFilm> unfinishedFilm(const FilmTask& task);

/// Draws and writes it. A film is whole or absent. Pictures that were drawn stay where it is stopped or fails, with
/// what is needed to resume it; a film that is resumed has the same bytes as one that never stopped. Throws as
/// checkFilm() does, FileError, Error where no frame can be read, Cancelled.
FilmResult makeFilm(const FilmTask& task, const JobControl& job = {});

} // namespace pellucid
