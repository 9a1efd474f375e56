// `share`: a scene as one web page.
#include "share/share.h"

#include <cstdio>

#include "commands.h"
#include "options/setting_options.h"
#include "output_files.h"
#include "render/memory_needs.h"
#include "resolve.h"

namespace pellucid::cli {

namespace {

struct ShareArguments {
    SceneOptions scene;
    SettingOptions<ShareSettings> share;
    std::string out;
};

void checkSuffix(const std::string& path) {
    if (!path.ends_with(".html") && !path.ends_with(".htm"))
        throw UsageError("a page is an HTML file", "--out", "give a name such as page.html");
}

std::string textOf(const SharedPage& page, const std::string& path) {
    const Int3& d = page.dims;
    std::string text = "wrote " + path + ": " + describeBytes(page.bytes) + ", " + std::to_string(d.x) + " x " +
                       std::to_string(d.y) + " x " + std::to_string(d.z) + " voxels of " + std::to_string(page.bits) +
                       " bits";
    if (page.factor > 1) text += ", made coarser by " + std::to_string(page.factor);
    return text + "\n";
}

Answer run(const ShareArguments& o, Progress& progress) {
    refuse({{o.scene.picture.transparent, "a page has no transparent background", "--background transparent",
             "give a colour"}});
    if (o.out.empty()) throw isRequired("--out", "share");
    const Opened opened = resolve(o.scene, progress, {toMeasure("sharing"), true});
    const Scene& scene = opened.scene;
    ShareTask task{scene, o.scene.picture.pictureOf(scene).settings, o.share.values(), o.out};
    checkShare(task);
    progress.finish();
    std::fprintf(stderr, "pellucid-cli: note: %s\n", kSharePrivacy); // before the page is there, not after
    const SharedPage page = makeShare(task, progress.phase("page"));

    std::vector<std::string> notices = opened.notices();
    notices.insert(notices.end(), page.leftOut.begin(), page.leftOut.end());
    const Int3& full = scene.volume->dims();
    Json json{{"command", "share"},
              {"file", o.out},
              {"bytes", page.bytes},
              {"voxel_bytes", page.packedBytes},
              {"dims", jsonFromDims(page.dims)},
              {"full_dims", jsonFromDims(full)},
              {"factor", page.factor},
              {"bits", page.bits},
              {"losses", {{"coarser", page.factor > 1}, {"largest_error", page.largestError}}},
              {"density", page.hasDensity},
              {"left_out", page.leftOut},
              {"volume", jsonFromVolume(*scene.volume)}};
    return {textOf(page, o.out), std::move(json), std::move(notices)};
}

} // namespace

Command addShare(CLI::App& program) {
    CLI::App* app =
        program.add_subcommand("share", "One HTML file that shows the volume in a browser, without a network");
    const auto o = std::make_shared<ShareArguments>();
    o->scene.addForFigures(*app);
    o->scene.picture.addLook(*app);
    o->share.add(*app, "Page");
    addOutputFile(*app, "--out", o->out, "the page: a file that ends in .html; it holds the voxels", checkSuffix);
    return {app, [o](Progress& progress) { return run(*o, progress); }};
}

} // namespace pellucid::cli
