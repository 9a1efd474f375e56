// `film`: a turntable, the frames of a series, or a way from view to view, as a film or as pictures.
#include "film/film.h"

#include "commands.h"
#include "film/movie_file.h"
#include "options/annotate_option.h"
#include "options/setting_options.h"
#include "output_files.h"
#include "render/memory_needs.h"
#include "resolve.h"

namespace pellucid::cli {

namespace {

struct Options {
    SceneOptions scene;
    SettingOptions<FilmSettings> film;
    std::optional<std::string> views;
    std::string out;
    AnnotationChoice annotate = AnnotationChoice::none();
};

/// What can be told before the volume is read.
void check(const Options& o) {
    if (o.out.empty()) throw isRequired("--out", "film");
    const FilmKind kind = o.film.values().kind;
    refuse(
        {{kind == FilmKind::Views && !o.views, "a way from view to view needs the views", "--kind", "add --views"},
         {kind != FilmKind::Views && o.views.has_value(), "this film has one view", "--views",
          "add --kind views, or leave it out"},
         {kind != FilmKind::Turntable && o.film.has("degrees"), "this film does not turn", "--degrees", "leave it out"},
         {kind == FilmKind::Series && o.film.has("seconds"),
          "a film of a series has one picture a frame, so --fps says how long it is", "--seconds", "leave it out"},
         {o.scene.picture.transparent, "a film has no transparent background", "--background transparent",
          "give a colour"}});
    if (isMovie(o.out))
        addOutputFile(o.out, "--out");
    else
        parseOutputFolder(o.out, "--out");
}

Answer run(const Options& o, Progress& progress) {
    check(o);
    const FilmSettings& settings = o.film.values();
    const Opened opened = resolve(o.scene, progress, {toView("drawing")});
    const std::vector<Camera> views =
        o.views ? atOption("--views", [&] { return viewsOfText(*o.views, opened.scene); }) : std::vector<Camera>();
    FilmTask task{opened.scene};
    task.shots = atOption("--kind", [&] { return shotsOf(settings, views, opened.scene); });
    task.width = o.scene.picture.size.width;
    task.height = o.scene.picture.size.height;
    task.framesPerSecond = settings.framesPerSecond;
    task.around = o.annotate;
    task.path = o.out;
    if (!isMovie(o.out))
        for (std::size_t n = 0; n < task.shots.size(); ++n)
            addOutputFile(o.out, pictureName(static_cast<int>(n)), "--out");
    const FilmResult film = makeFilm(task, progress.phase("pictures"));

    std::vector<std::string> notices = opened.notices();
    notices.insert(notices.end(), film.passedOver.begin(), film.passedOver.end());
    const double seconds = film.pictures / settings.framesPerSecond;
    Json json{{"command", "film"},
              {"volume", jsonFromVolume(*opened.scene.volume)},
              {"kind", name(settings.kind)},
              {"file", o.out},
              {"size", {task.width, task.height}},
              {"pictures", film.pictures},
              {"fps", settings.framesPerSecond},
              {"seconds", seconds}};
    return {"wrote " + o.out + ": " + std::to_string(film.pictures) + " pictures of " + std::to_string(task.width) +
                " x " + std::to_string(task.height) + " pixels, " + secondsText(seconds) + " at " +
                plainText(settings.framesPerSecond) + " a second\n",
            std::move(json), std::move(notices)};
}

} // namespace

Command addFilm(CLI::App& program) {
    CLI::App* app = program.add_subcommand("film", "A film of a volume: turning, over time, or from view to view");
    const auto o = std::make_shared<Options>();
    o->scene.addForView(*app, VolumeOptions::SizeIs::Image);
    o->scene.picture.add(*app);
    o->scene.ground.add(*app);
    o->scene.overlay.add(*app);
    o->scene.coordinates.add(*app);
    o->film.add(*app);
    addValue(*app, "--views", "VIEW;VIEW[;…]", o->views, anyText,
             "the views that the film goes through, each as --view takes it, or present for that of --view or the "
             "session");
    addAnnotate(*app, o->annotate,
                "draw annotations over the pictures: all, or some of cube, letters, axes, scale, legend, title, "
                "measures with commas between");
    addValue(*app, "--out", "FILE.mp4|DIR", o->out, anyText,
             "the film, by ffmpeg; or a folder, which gets picture_00000.png and so on");
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
