// `compare`: two pictures; or two transfer functions, views or frames, as pictures and figures.
#include <algorithm>
#include <filesystem>

#include "base/text.h"
#include "commands.h"
#include "engines/engines.h"
#include "image_io/image_file.h"
#include "output_files.h"
#include "parse.h"
#include "prepare.h"
#include "render/memory_needs.h"
#include "report/comparison_files.h"
#include "resolve.h"

namespace pellucid::cli {

namespace {

struct CompareArguments {
    std::string a, b;
    SceneOptions scene;
    CameraOptions viewOfB;
    std::optional<int> frameOfB;
    std::optional<std::string> difference, sideBySide, figures;
};

/// One side, and remarks about it.
struct Side {
    std::string name;
    ComparedSide compared;
    std::vector<std::string> notices;
};

bool isPicture(const std::string& name) {
    const std::string suffix = lowerCase(std::filesystem::path(name).extension().string());
    const auto known = {".png", ".tif", ".tiff", ".exr", ".jpg", ".jpeg"};
    return std::ranges::find(known, suffix) != known.end();
}

bool isSession(const std::string& name) { return lowerCase(name).ends_with(".pellucid.json"); }

void check(const CompareArguments& o) {
    const bool a = isPicture(o.a), b = isPicture(o.b);
    if (o.b.empty() && !isSession(o.a))
        throw UsageError("B is missing", o.a, "name what it is compared with; a session alone may keep it");
    if (a != b && !o.b.empty())
        throw UsageError("one is a picture and the other is not", o.a + " and " + o.b,
                         "name two pictures, or two transfer functions or sessions");
    refuse({{a && o.scene.volume.path.has_value(), "two pictures need no volume", "VOLUME", "leave it out"}});
}

/// B as the session of A keeps it.
Scene keptB(const CompareArguments& o, const Scene& a, Progress& progress) {
    Session session = a.session;
    if (!session.comparison->b)
        throw UsageError("the session keeps nothing to compare with", o.a,
                         "name B, or pin a state in the window and save the session again");
    session.comparison.edit([&](ComparisonView& view) {
        view.sameView = view.sameView || o.viewOfB.view || o.viewOfB.namedView;
        view.sameFrame = view.sameFrame || o.frameOfB;
    });
    session.camera = a.camera;
    return pellucid::resolve(comparedSession(session), a, toMeasureAndDrawField(), progress.phase("loading"));
}

Side drawn(const CompareArguments& o, bool isB, Progress& progress) {
    SceneOptions options = o.scene;
    const bool isKept = isB && o.b.empty();
    const std::string& name = isB && !isKept ? o.b : o.a;
    if (isSession(name))
        options.sessionFile = name;
    else
        options.tf.spec = name;
    if (isB && (o.viewOfB.view || o.viewOfB.namedView)) {
        options.camera.file.reset();
        options.camera.view = o.viewOfB.view;
        options.camera.namedView = o.viewOfB.namedView;
    }
    if (isB && o.frameOfB) options.volume.frame = o.frameOfB;
    const Opened opened = resolve(options, progress, {toMeasureAndDrawField(), true});
    const Scene scene = isKept ? keptB(o, opened.scene, progress) : opened.scene;
    const MeasureInput input = measureInput(scene);
    Workspace workspace;
    prepare(workspace, input, progress);
    const SideInput side = sideInput(scene, options.picture.pictureOf(scene), true);
    const Measures measures = workspace.measure(input, progress.phase("visibility"));
    const auto renderer = makeRenderer(scene.session.measure->engine, side.picture.volume);
    return {isKept ? opened.scene.session.comparison->b->name : name,
            comparedSide(side, measures, *renderer, progress.phase("pictures")), opened.notices()};
}

std::string tableOf(const Comparison& comparison) {
    std::vector<std::string> head{"feature"};
    for (const ComparedFigure& figure : comparedFigures())
        head.insert(head.end(), {std::string(figure.words) + " A", "B"});
    Table table(head);
    for (const FeaturePair& pair : comparison.features) {
        std::vector<std::string> row{pair.name + (pair.isEmpty() ? " (empty)" : "")};
        for (const ComparedFigure& figure : comparedFigures())
            for (const auto* of : {&pair.a, &pair.b}) row.push_back(*of ? fixedText(*figure.of(**of), 4) : "-");
        table.add(row);
    }
    return table.text();
}

Answer run(const CompareArguments& o, Progress& progress) {
    const Stopwatch total;
    check(o);
    const bool files = isPicture(o.a);
    const auto side = [&](bool isB) {
        const std::string& name = isB ? o.b : o.a;
        if (!files) return drawn(o, isB, progress);
        addInputFile(name);
        return Side{name, {readImage(name), {}}, {}};
    };
    Side a = side(false), b = side(true);
    const Comparison comparison = comparisonOf(a.name, std::move(a.compared), b.name, std::move(b.compared));
    std::string text = (files ? "" : tableOf(comparison)) + wordsOf(comparison.difference) + "\n";
    Json json{{"command", "compare"}};
    json.update(jsonOf(comparison));
    const auto write = [&](const std::optional<std::string>& path, const auto& writer) {
        if (!path) return;
        writer(*path);
        text += "wrote " + *path + "\n";
        json["files"].push_back(*path);
    };
    write(o.difference, [&](const std::string& path) { writeDifference(comparison.difference, path); });
    write(o.sideBySide,
          [&](const std::string& path) { writeImage(sideBySide(comparison.imageA, comparison.imageB), path); });
    write(o.figures, [&](const std::string& path) { writeFigures(comparison, path); });
    json["seconds"] = {{"total", total.seconds()}};
    Answer answer{std::move(text), std::move(json), a.notices};
    for (const std::string& notice : b.notices)
        if (std::ranges::find(a.notices, notice) == a.notices.end()) answer.notices.push_back(notice);
    return answer;
}

} // namespace

Command addCompare(CLI::App& program) {
    CLI::App* app = program.add_subcommand(
        "compare", "How alike two pictures are; or two transfer functions, views or frames of a volume, with figures");
    const auto o = std::make_shared<CompareArguments>();
    app->add_option("A", o->a,
                    "a picture (.png, .tif, .exr, .jpg), a session (*.pellucid.json), or a transfer function of "
                    "VOLUME, as --tf of the other commands takes it")
        ->required()
        ->type_name("");
    app->add_option("B", o->b, "likewise; left out, what the session A keeps to be compared with")->type_name("");
    o->scene.volume.add(*app, VolumeOptions::SizeIs::Image);
    o->scene.variables.add(*app);
    o->scene.camera.add(*app);
    o->scene.clip.add(*app);
    o->scene.engine.add(*app);
    o->scene.saliency.add(*app);
    o->viewOfB.addView(*app, "--view-b", "the view of B (default: that of A, or of its session)");
    addValue(*app, "--frame-b", "N", o->frameOfB, wholeFrom(0, 1'000'000'000),
             "the frame of B, from 0 (default: that of A, or of its session)");
    o->scene.picture.add(*app);
    o->scene.ground.add(*app);
    o->scene.overlay.add(*app);
    addOutputFile(*app, "--difference", o->difference,
                  "write delta E of each pixel: .exr (floats) or .png (16 bits, white at 100)", checkPlaneSuffix);
    addOutputFile(*app, "--side-by-side", o->sideBySide, "write both as one picture: .png, .tif, .exr or .jpg",
                  checkImageSuffix);
    addOutputFile(*app, "--figures", o->figures, "write the figures of both as a table (.csv) or as JSON (.json)",
                  checkFiguresSuffix);
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
