// `film`: a turntable, the frames of a series, a way from view to view, or keyframes, as a film or as pictures.
#include "film/film.h"

#include "commands.h"
#include "film/film_progress.h"
#include "film/movie_file.h"
#include "options/annotate_option.h"
#include "options/setting_options.h"
#include "output_files.h"
#include "render/memory_needs.h"
#include "resolve.h"
#include "session/keyframes_file.h"
#include "stop_note.h"

namespace pellucid::cli {

namespace {

struct FilmArguments {
    SceneOptions scene;
    SettingOptions<FilmSettings> film;
    std::optional<std::string> views;
    std::optional<std::string> keyframes;
    bool resume = false;
    std::string out;
    AnnotationChoice annotate = AnnotationChoice::none();
};

/// What can be told before the volume is read.
void check(const FilmArguments& o) {
    if (o.out.empty()) throw isRequired("--out", "film");
    atOption("--out", [&] { checkFilmSuffix(o.out); });
    const FilmKind kind = o.film.values().kind;
    refuse(
        {{kind == FilmKind::Views && !o.views, "a way from view to view needs the views", "--kind", "add --views"},
         {kind != FilmKind::Views && o.views.has_value(), "this film has one view", "--views",
          "add --kind views, or leave it out"},
         {kind == FilmKind::Keys && !o.keyframes, "keyframes are asked for and none are named", "--kind",
          "add --keyframes"},
         {kind != FilmKind::Keys && o.keyframes.has_value(), "this film has no keyframes", "--keyframes",
          "add --kind keyframes, or leave it out"},
         {o.keyframes && isFilmFile(*o.keyframes) && o.film.has("seconds"), "the keys say how long the film is",
          "--seconds", "leave it out"},
         {kind != FilmKind::Turntable && o.film.has("degrees"), "this film does not turn", "--degrees", "leave it out"},
         {kind == FilmKind::Series && o.film.has("seconds"),
          "a film of a series has one picture a frame, so --fps says how long it is", "--seconds", "leave it out"},
         {o.scene.picture.transparent, "a film has no transparent background", "--background transparent",
          "give a colour"}});
    if (filmFileOf(o.out) != FilmFile::Pictures) addOutputFile(o.out, "--out");
    parseOutputFolder(picturesFolderOf(o.out), "--out");
}

/// Which pictures the task has.
void addShots(const FilmArguments& o, FilmTask& task) {
    const FilmSettings& settings = o.film.values();
    if (settings.kind == FilmKind::Keys) {
        task.keys =
            atOption("--keyframes", [&] { return keyframesOfText(*o.keyframes, settings.seconds, task.scene); });
        task.shots = atOption(
            "--kind", [&] { return shotsOf(task.keys, settings.framesPerSecond, task.scene.volume->geometry()); });
        return;
    }
    const std::vector<Camera> views =
        o.views ? atOption("--views", [&] { return viewsOfText(*o.views, task.scene); }) : std::vector<Camera>();
    task.shots = atOption("--kind", [&] { return shotsOf(settings, views, task.scene); });
}

/// Where it is stopped, it is said how the film goes on.
FilmResult make(const FilmTask& task, Progress& progress) {
    try {
        return makeFilm(task, progress.phase("pictures"));
    } catch (const Cancelled&) {
        if (const auto unfinished = unfinishedFilm(task); unfinished && unfinished->pictures > 0)
            stopNote() = std::to_string(unfinished->pictures) + " of " + std::to_string(task.shots.size()) +
                         " pictures are in " + picturesFolderOf(task.path) +
                         ": the same command with --resume draws the rest";
        throw;
    }
}

Answer run(const FilmArguments& o, Progress& progress) {
    check(o);
    const FilmSettings& settings = o.film.values();
    const Opened opened = resolve(o.scene, progress, {toView("drawing")});
    FilmTask task{opened.scene};
    addShots(o, task);
    task.width = o.scene.picture.size.width;
    task.height = o.scene.picture.size.height;
    task.framesPerSecond = settings.framesPerSecond;
    task.around = o.annotate;
    task.path = o.out;
    task.resume = o.resume;
    const std::string folder = picturesFolderOf(o.out);
    for (std::size_t n = 0; n < task.shots.size(); ++n)
        addOutputFile(folder, pictureName(static_cast<int>(n)), "--out");
    addOutputFile(folder, kFilmProgressFile, "--out");
    const FilmResult film = make(task, progress);

    std::vector<std::string> notices = opened.notices();
    notices.insert(notices.end(), film.passedOver.begin(), film.passedOver.end());
    if (film.kept > 0) notices.push_back(std::to_string(film.kept) + " of the pictures had been drawn before");
    const double seconds = film.pictures / settings.framesPerSecond;
    Json json{{"command", "film"},
              {"volume", jsonFromVolume(*opened.scene.volume)},
              {"kind", name(settings.kind)},
              {"file", o.out},
              {"size", {task.width, task.height}},
              {"pictures", film.pictures},
              {"kept", film.kept},
              {"fps", settings.framesPerSecond},
              {"seconds", seconds}};
    return {"wrote " + o.out + ": " + std::to_string(film.pictures) + " pictures of " + std::to_string(task.width) +
                " x " + std::to_string(task.height) + " pixels, " + secondsText(seconds) + " at " +
                plainText(settings.framesPerSecond) + " a second\n",
            std::move(json), std::move(notices)};
}

} // namespace

Command addFilm(CLI::App& program) {
    CLI::App* app =
        program.add_subcommand("film", "A film of a volume: turning, over time, from view to view, or from key to key");
    const auto o = std::make_shared<FilmArguments>();
    o->scene.addForView(*app, VolumeOptions::SizeIs::Image);
    o->scene.picture.add(*app);
    o->scene.ground.add(*app);
    o->scene.overlay.add(*app);
    o->scene.coordinates.add(*app);
    o->film.add(*app);
    addValue(*app, "--views", "VIEW;VIEW[;…]", o->views, anyText,
             "the views that the film goes through, each as --view takes it, or present for that of --view or the "
             "session");
    addValue(*app, "--keyframes", "FILE.film.json|SESSION;SESSION[;…]", o->keyframes, anyText,
             "keyframes of view, transfer function, clipping, light and frame, as a file; or sessions "
             "at equal times over --seconds");
    app->add_flag(
        "--resume", o->resume,
        "take the pictures that this film had when it was stopped, and draw the rest; the result is the same");
    addAnnotate(*app, o->annotate,
                "draw annotations over the pictures: all, or some of cube, letters, axes, scale, legend, title, "
                "measures with commas between");
    addValue(*app, "--out", "FILE|DIR", o->out, anyText,
             "the film: .mp4, .webm or .gif by ffmpeg, .apng without; or a folder, which gets picture_00000.png and "
             "so on");
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
