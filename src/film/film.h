// Films of a scene: which picture comes when, and the pictures as files.
#pragma once

#include <string>
#include <vector>

#include "base/enum_names.h"
#include "base/job.h"
#include "base/setting.h"
#include "session/scene.h"

namespace pellucid {

enum class FilmKind {
    Turntable, ///< once around the volume
    Series,    ///< each frame of the series, from the present view
    Views      ///< from view to view
};
template <>
inline constexpr auto kNamesOf<FilmKind> = enumNames("film", "turntable", "series", "views");

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

struct FilmTask {
    Scene scene;
    std::vector<FilmShot> shots = {};
    int width = 1280, height = 720; ///< pixels
    double framesPerSecond = 25;
    AnnotationChoice around = AnnotationChoice::none(); ///< what stands around each picture
    std::string path = {}; ///< F.mp4, or a folder, new or not: it gets picture_00000.png …
};

struct FilmResult {
    int pictures = 0;
    std::vector<std::string> passedOver; ///< frames that could not be read: "frame 3: …"
};

/// What can be told before any work: throws Error where a film is wanted and no ffmpeg is there, where the session
/// shows a field in the place of the data, and for a size that is none.
void checkFilm(const FilmTask& task);
std::string pictureName(int picture);                            ///< "picture_00012.png"
std::string pictureFileOf(const std::string& path, int picture); ///< that in the folder `path`
/// Draws and writes it. A film is whole or absent; of pictures those that were drawn stay. Throws as checkFilm() does,
/// FileError, Error where no frame can be read, Cancelled.
FilmResult makeFilm(const FilmTask& task, const JobControl& job = {});

} // namespace pellucid
