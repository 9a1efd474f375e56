#include "film/film.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <numbers>
#include <optional>

#include <glm/geometric.hpp>
#include <glm/gtc/quaternion.hpp>

#include "base/error.h"
#include "base/text.h"
#include "engines/engines.h"
#include "film/film_progress.h"
#include "film/movie_file.h"
#include "image_io/animated_png.h"
#include "image_io/image_file.h"
#include "render/annotation_raster.h"
#include "render/camera_motion.h"
#include "render/view_text.h"

namespace pellucid {

namespace fs = std::filesystem;

namespace {

constexpr double kRadians = std::numbers::pi / 180;

/// Right, up and toward the viewer as columns.
Mat3 turnOf(const Camera& camera) { return {camera.right(), camera.trueUp(), -camera.forward()}; }

/// Lengths and angles grow by equal factors in equal times.
double between(double a, double b, double t) { return a * std::pow(b / a, t); }

Vec3 turntableAxis(const Camera& camera) {
    const Vec3 up = camera.trueUp();
    int axis = 0;
    for (int a = 1; a < 3; ++a)
        if (std::abs(up[a]) > std::abs(up[axis])) axis = a;
    Vec3 nearest(0);
    nearest[axis] = up[axis] < 0 ? -1 : 1;
    return nearest;
}

Camera turnedAbout(const Camera& camera, const Vec3& axis, double degrees) {
    const glm::dquat turn = glm::angleAxis(degrees * kRadians, axis);
    Camera turned = camera;
    turned.eye = camera.center + turn * (camera.eye - camera.center);
    turned.up = turn * camera.trueUp();
    return turned;
}

void checkCount(double pictures) {
    if (pictures > kMostFilmPictures)
        throw UsageError("the film would have more than " + std::to_string(kMostFilmPictures) + " pictures", "",
                         "make it shorter, or take fewer pictures a second");
}

int picturesIn(const FilmSettings& settings) {
    const double wanted = std::round(settings.seconds * settings.framesPerSecond);
    checkCount(wanted);
    return std::max(1, static_cast<int>(wanted));
}

/// The scene at each frame that is asked for, one after the other; its own frame is there already.
class Frames {
public:
    explicit Frames(const Scene& scene) : m_scene(scene) {}

    /// Null: it cannot be read, and why() tells.
    const Scene* at(int frame, const JobControl& job) {
        if (frame == m_scene.session.frame) return &m_scene;
        Session session = m_scene.session;
        session.frame = frame;
        try {
            m_scene = resolve(std::move(session), m_scene, {}, job);
        } catch (const FileError& e) {
            m_why = e.what();
            return nullptr;
        }
        return &m_scene;
    }
    const std::string& why() const { return m_why; }

private:
    Scene m_scene;
    std::string m_why;
};

/// Draws the pictures of one film.
class Artist {
public:
    explicit Artist(const FilmTask& task) : m_task(task) {}

    /// `scene` is at the shot's frame.
    Image draw(const Scene& scene, const FilmShot& shot, const JobControl& job) {
        if (shot.time) {
            const KeyState state = stateAt(m_task.keys, *shot.time, scene.volume->geometry());
            return draw(withKeyState(scene, state), state.camera, job);
        }
        return draw(scene, shot.camera, job);
    }

private:
    Image draw(const Scene& scene, const Camera& camera, const JobControl& job) {
        PictureInput picture = pictureInput(scene, m_task.width, m_task.height);
        picture.camera = camera;
        picture.settings.validate();
        if (picture.volume != m_volume) { // a renderer is of one volume
            m_volume = picture.volume;
            m_renderer = makeRenderer(scene.session.measure->engine, picture.volume);
            if (m_task.around.any() && m_task.around.measures)
                m_readings = readRulers(*scene.session.rulers, *scene.data, job);
        }
        Image image = m_renderer->render(picture.camera, picture.tf, picture.settings, {job.stop, {}});
        if (m_task.around.any()) {
            AnnotationInput around = annotationInput(picture, m_task.around);
            addMeasures(around, scene, m_readings);
            drawMarks(image, annotationMarks(around));
        }
        return image;
    }

    const FilmTask& m_task;
    std::shared_ptr<const Volume> m_volume;
    std::unique_ptr<ImageRenderer> m_renderer;
    RulerReadings m_readings;
};

} // namespace

template <>
std::span<const Setting> settingsOf<FilmSettings>() {
    using F = FilmSettings;
    constexpr auto hasLength = [](const void* f) {
        const FilmKind kind = static_cast<const F*>(f)->kind;
        return kind == FilmKind::Turntable || kind == FilmKind::Views;
    };
    constexpr auto turns = [](const void* f) { return static_cast<const F*>(f)->kind == FilmKind::Turntable; };
    static constexpr const char* kKinds[] = {"Turntable", "Frames of the series", "From view to view", "Keyframes"};
    static const Setting kSettings[] = {
        {.key = "kind",
         .at = member<&F::kind>,
         .words = "&Kind",
         .help =
             "What the film shows: the volume turning once around, every frame of the series from the present view, "
             "a way from view to view, or keyframes of view, transfer function, clipping, light and frame.",
         .choices = kKinds},
        {.key = "seconds",
         .at = member<&F::seconds>,
         .words = "&Length",
         .help = "How long a turntable takes, or the way through all views or sessions.",
         .range = {0, 3600, NumberRange::Open::Low},
         .unit = "s",
         .used = hasLength},
        {.key = "fps",
         .at = member<&F::framesPerSecond>,
         .words = "&Frames per second",
         .help = "How many pictures the film shows in a second.",
         .range = {0, 120, NumberRange::Open::Low}},
        {.key = "degrees",
         .at = member<&F::degrees>,
         .words = "&Turn",
         .help = "How far a turntable turns; a negative angle turns it the other way.",
         .range = {-36000, 36000},
         .unit = "°",
         .used = turns},
    };
    return kSettings;
}

Camera cameraBetween(const Camera& a, const Camera& b, double t) {
    const double eased = t * t * (3 - 2 * t);
    Camera camera = a;
    camera.center = a.center + (b.center - a.center) * eased;
    const glm::dmat3 turn = glm::mat3_cast(
        glm::slerp(glm::normalize(glm::quat_cast(turnOf(a))), glm::normalize(glm::quat_cast(turnOf(b))), eased));
    const double distance = between(glm::length(a.eye - a.center), glm::length(b.eye - b.center), eased);
    camera.eye = camera.center + turn[2] * distance;
    camera.up = turn[1];
    camera.fovY = between(a.fovY, b.fovY, eased);
    camera.height = between(a.height, b.height, eased);
    return camera;
}

std::vector<Camera> viewsOfText(const std::string& text, const Scene& scene) {
    const Geometry& geometry = scene.volume->geometry();
    const Projection projection = scene.camera.projection;
    std::vector<Camera> views;
    std::size_t at = 0;
    while (at <= text.size()) {
        const std::size_t end = std::min(text.find(';', at), text.size());
        const std::string one = trimmed(text.substr(at, end - at));
        at = end + 1;
        if (one.empty()) continue;
        if (one == "present") {
            views.push_back(scene.camera);
            continue;
        }
        const WordedView worded = viewFromText(one);
        const auto* const named = std::get_if<NamedView>(&worded);
        const ViewAngles angles =
            named != nullptr ? anglesOf(*named, geometry.worldAxes) : std::get<ViewAngles>(worded);
        views.push_back(cameraFromView(geometry, angles.azimuth, angles.elevation, angles.zoom, projection));
    }
    if (views.size() < 2)
        throw UsageError("a way from view to view needs two views at least", "",
                         "name them with semicolons between, such as anterior; left; 30,20,1.5");
    return views;
}

std::vector<FilmShot> shotsOf(const FilmSettings& settings, const std::vector<Camera>& views, const Scene& scene) {
    std::vector<FilmShot> shots;
    const int frame = scene.session.frame;
    if (settings.kind == FilmKind::Series) {
        if (!scene.series->varies())
            throw UsageError("there is no series: the data have one frame", "", "choose another kind of film");
        for (int n = 0; n < scene.series->size(); ++n) shots.push_back({n, scene.camera});
        return shots;
    }
    const int count = picturesIn(settings);
    if (settings.kind == FilmKind::Turntable) {
        const Vec3 axis = turntableAxis(scene.camera);
        for (int n = 0; n < count; ++n)
            shots.push_back({frame, turnedAbout(scene.camera, axis, settings.degrees * n / count)});
        return shots;
    }
    const double ways = static_cast<double>(views.size()) - 1;
    for (int n = 0; n < count; ++n) {
        const double at = count > 1 ? ways * n / (count - 1) : 0;
        const auto from = static_cast<std::size_t>(std::min(std::floor(at), ways - 1));
        shots.push_back({frame, cameraBetween(views[from], views[from + 1], at - static_cast<double>(from))});
    }
    return shots;
}

double picturesOf(double seconds, double framesPerSecond) { return std::floor(seconds * framesPerSecond + 1e-6) + 1; }

std::vector<FilmShot> shotsOf(const Keyframes& keys, double framesPerSecond, const Geometry& geometry) {
    if (keys.empty()) throw UsageError("the film has no keys", "", "add a key");
    const double begin = keys.front().time, pictures = picturesOf(keys.back().time - begin, framesPerSecond);
    checkCount(pictures);
    std::vector<FilmShot> shots;
    for (int n = 0; n < static_cast<int>(pictures); ++n) {
        const double time = begin + n / framesPerSecond;
        shots.push_back({frameAt(keys, time), cameraAt(keys, time, geometry), time});
    }
    return shots;
}

std::string pictureName(int picture) {
    std::array<char, 32> name{};
    std::snprintf(name.data(), name.size(), "picture_%05d.png", picture);
    return name.data();
}

std::string pictureFileOf(const std::string& path, int picture) {
    return (fs::path(path) / pictureName(picture)).string();
}

std::string picturesFolderOf(const std::string& path) {
    if (filmFileOf(path) == FilmFile::Pictures) return path;
    // A name that is as long as can be has no room for more: its end stands for it.
    constexpr const char* kSuffix = ".pictures";
    constexpr std::size_t kMost = 255 - 9; // bytes of a file's name
    const fs::path file(path);
    std::string name = file.filename().string();
    if (name.size() > kMost) name.erase(0, name.size() - kMost);
    while (!name.empty() && (static_cast<unsigned char>(name.front()) & 0xc0) == 0x80)
        name.erase(0, 1); // whole letters
    return (file.parent_path() / (name + kSuffix)).string();
}

std::optional<UnfinishedFilm> unfinishedFilm(const FilmTask& task) {
    const std::string folder = picturesFolderOf(task.path);
    const auto digest = readFilmProgress(folder);
    if (!digest) return {};
    UnfinishedFilm film{0, *digest == filmDigest(task)};
    const int all = static_cast<int>(task.shots.size());
    while (film.pictures < all && fs::is_regular_file(pictureFileOf(folder, film.pictures))) ++film.pictures;
    return film;
}

void checkFilm(const FilmTask& task) {
    if (task.path.empty()) throw UsageError("the film has no name", "", "name a file that ends in .mp4, or a folder");
    checkFilmSuffix(task.path);
    const FilmFile file = filmFileOf(task.path);
    if (needsMovieWriter(file) && !hasMovieWriter())
        throw Error("ffmpeg, which writes films, is not installed", task.path,
                    "install it, or name a file that ends in .apng, or a folder, which gets the pictures one by one");
    if (task.scene.session.field->kind)
        throw Error("a film shows the data, and a field is shown in their place", task.scene.volume->title,
                    "switch the field off");
    const std::string folder = picturesFolderOf(task.path);
    if (fs::exists(folder) && !fs::is_directory(folder))
        throw FileError("this is no folder, and its suffix is that of no film", folder,
                        "name a file that ends in .mp4, .webm, .gif or .apng, or a folder");
    if (file != FilmFile::Pictures && fs::is_directory(task.path))
        throw FileError("this is a folder, and a film would be a file", task.path, "give another name");
    if (file != FilmFile::Pictures && fs::exists(folder) && !fs::is_empty(folder) && !readFilmProgress(folder))
        throw FileError("the pictures of the film would come into this folder, and there are others in it", folder,
                        "move the folder, or give the film another name");
    RenderSettings size;
    size.width = task.width;
    size.height = task.height;
    size.validate();
    if (!task.resume) return;
    if (const auto unfinished = unfinishedFilm(task); unfinished && !unfinished->isThisOne)
        throw Error("another film was begun here", folder, "begin anew, or give this film another name");
}

namespace {

/// The folder of the pictures while a film is drawn.
class PictureStore {
public:
    explicit PictureStore(const FilmTask& task)
        : m_task(task), m_isFile(filmFileOf(task.path) != FilmFile::Pictures), m_folder(picturesFolderOf(task.path)) {
        std::error_code failure;
        fs::create_directories(m_folder, failure);
        if (failure && !fs::is_directory(m_folder))
            throw FileError("the folder cannot be created: " + failure.message(), m_folder,
                            "check permissions and space");
        m_resumes = task.resume && readFilmProgress(m_folder);
    }
    ~PictureStore() {
        std::error_code none;
        if (m_isFile && m_files.empty()) fs::remove(m_folder, none); // an empty one only
    }
    PictureStore(const PictureStore&) = delete;
    PictureStore& operator=(const PictureStore&) = delete;

    const std::vector<std::string>& files() const { return m_files; }
    int kept() const { return m_kept; }

    /// Whether the next picture is there already.
    bool keepNext() {
        const std::string file = next();
        if (!m_resumes || !isWholePngFile(file, m_task.width, m_task.height)) return false;
        m_files.push_back(file);
        ++m_kept;
        return true;
    }
    void add(const Image& image) {
        if (!m_resumes && m_files.empty()) begin();
        const std::string file = next();
        writeImage(image, file);
        m_files.push_back(file);
    }
    /// The film is whole: it needs no more what it was made with.
    void finish() {
        if (m_isFile) removePictures();
        removeFilmProgress(m_folder);
        std::error_code none;
        if (m_isFile) fs::remove(m_folder, none);
    }

private:
    std::string next() const { return pictureFileOf(m_folder, static_cast<int>(m_files.size())); }
    /// What this film will write over goes first: none of it shall be taken for a picture of this film.
    void begin() {
        removeFilmProgress(m_folder);
        removePictures();
        writeFilmProgress(filmDigest(m_task), m_folder);
    }
    /// Of a folder beside a film all, else those of this film's numbers.
    void removePictures() {
        const auto remove = [&](std::size_t n) {
            std::error_code none;
            return fs::remove(pictureFileOf(m_folder, static_cast<int>(n)), none);
        };
        std::size_t n = 0;
        for (; n < m_task.shots.size(); ++n) remove(n);
        while (m_isFile && remove(n)) ++n;
    }

    const FilmTask& m_task;
    const bool m_isFile;
    const std::string m_folder;
    bool m_resumes = false;
    std::vector<std::string> m_files;
    int m_kept = 0;
};

} // namespace

FilmResult makeFilm(const FilmTask& task, const JobControl& job) {
    checkFilm(task);
    PictureStore store(task);
    Frames frames(task.scene);
    Artist artist(task);
    FilmResult result;
    int broken = -1; // the frame that could not be read last
    for (std::size_t n = 0; n < task.shots.size(); ++n) {
        job.throwIfStopped();
        const FilmShot& shot = task.shots[n];
        if (shot.frame == broken) continue;
        const Scene* const scene = frames.at(shot.frame, {job.stop, {}});
        if (scene == nullptr) {
            broken = shot.frame;
            result.passedOver.push_back("frame " + std::to_string(broken) + ": " + frames.why());
            continue;
        }
        if (!store.keepNext()) store.add(artist.draw(*scene, shot, job));
        // The film itself takes a little time, too.
        job.report(0.97 * static_cast<double>(n + 1) / static_cast<double>(task.shots.size()));
    }
    if (store.files().empty())
        throw Error("no frame can be read", task.scene.series->listing().title, "check its files");
    if (filmFileOf(task.path) != FilmFile::Pictures)
        writeMovie(store.files(), task.framesPerSecond, task.path, job.stop);
    job.report(1);
    result.pictures = static_cast<int>(store.files().size());
    result.kept = store.kept();
    store.finish();
    return result;
}

} // namespace pellucid
