#include "reproduce/search_cases.h"

#include <algorithm>

#include "base/text.h"
#include "report/convergence.h"
#include "report/drawing_file.h"

namespace pellucid::cli {

namespace {

constexpr double kConverged = 0.03; ///< F, §5.4
// The peaks of table 5.1's starts, of 255, which are the targets, too (docs/method.md, "The published profile").
const std::vector<double> kProportional{26 / 255.0, 77 / 255.0, 153 / 255.0};
constexpr const char* kProportionalTargets = "26,77,153";
// The colours that the thesis's text speaks of.
const Rgb kPurple = rgbFromHex("#9900ff"), kRed = rgbFromHex("#ff0000"), kGreen = rgbFromHex("#04ff00"),
          kBlue = rgbFromHex("#00aaff"), kYellow = rgbFromHex("#ffff00");

} // namespace

const std::vector<SearchCase>& searchCases() {
    static const std::vector<SearchCase> cases{{"nucleon",
                                                {"nucleon (41×41×41)", "shells", "nucleon/nucleon.mhd"},
                                                41,
                                                "front",
                                                "180,0",
                                                kProportional,
                                                {kPurple, kRed, kGreen},
                                                "nucleon_naive_proportional.tfi",
                                                kProportionalTargets,
                                                {{{17, 1.07}, {2, 0.59}, {2, 0.38}}}},
                                               {"tooth",
                                                {"tooth (140×120×161)", "knee", "tooth/tooth.mhd"},
                                                64,
                                                "front",
                                                "180,0",
                                                kProportional,
                                                {kBlue, kRed, kYellow},
                                                "tooth_naive_proportional.tfi",
                                                kProportionalTargets,
                                                {{{21, 7.56}, {2, 3.25}, {2, 1.57}}}},
                                               {"CT-Knee",
                                                {"CT-Knee (379×229×305)", "knee"},
                                                64,
                                                "back",
                                                "0,0",
                                                kProportional,
                                                {kRed, kGreen, kPurple},
                                                "",
                                                kProportionalTargets,
                                                {{{17, 33.84}, {2, 17.81}, {2, 9.26}}}},
                                               {"vortex",
                                                {"vortex, time step 1 (128×128×128)", "vortex", "vortex/vorts1.mhd"},
                                                64,
                                                "top",
                                                "0,90",
                                                {1 / 3.0, 1 / 3.0, 1 / 3.0},
                                                {kPurple, kRed, kGreen},
                                                "",
                                                "equal",
                                                {{{33, 14.00}, {13, 15.22}, {13, 8.40}}}}};
    return cases;
}

std::vector<DataNeed> dataOf(const std::vector<SearchCase>& cases) {
    std::vector<DataNeed> needs;
    for (const SearchCase& each : cases) needs.push_back(each.data);
    return needs;
}

Search searchOf(const Json& optimized) {
    return {optimized.at("converged"),   optimized.at("iterations"),
            optimized.at("evaluations"), optimized.at("seconds").at("search"),
            optimized.at("objective"),   optimized.at("vws"),
            optimized.at("opacity")};
}

TransferFunction threeTents(const std::vector<double>& peaks, const std::array<Rgb, 3>& colors) {
    TransferFunction tf = withFeatureOpacities(tents(3), peaks);
    for (std::size_t f = 0; f < 3; ++f) {
        tf.features[f].color = colors[f];
        for (std::size_t p = 0; p < 3; ++p) tf.points[3 * f + p].color = colors[f];
    }
    return tf;
}

CaseAtDesk::CaseAtDesk(Desk& desk, const SearchCase& of, std::size_t need, std::vector<double> peaks,
                       const std::string& thesisStart)
    : m_desk(desk), m_case(of),
      m_source(realFileOf(of.data, desk.settings())
                   ? desk.data(need)
                   : desk.sample(of.data.sample, std::min(of.sampleSize, desk.settings().sampleSize), of.data.thesis)) {
    const std::string& file = thesisStart.empty() ? of.thesisStart : thesisStart;
    const std::string known = std::string(kThesisLink) + "/" + file;
    std::error_code ec;
    m_isTheThesiss = m_source.isTheSame && !file.empty() && std::filesystem::exists(desk.settings().folder / known, ec);
    if (m_isTheThesiss)
        m_start = known;
    else
        m_start = desk.writeTf(of.name + "_start", threeTents(peaks.empty() ? of.peaks : peaks, of.colors));
}

Words CaseAtDesk::measured() const { return m_source.words + Words{"--profile", "published", "--along", m_case.along}; }

Words CaseAtDesk::drawn() const { return m_source.words + Words{"--view", m_case.view, "--orthographic"}; }

Search CaseAtDesk::search(const std::string& name, const std::string& method, const Words& more) {
    return searchOf(m_desk.ask(name, Words{"optimize"} + measured() +
                                         Words{"--tf", m_start, "--target", m_case.targets, "--method", method} +
                                         more));
}

Plot objectivesPlot(const std::string& title, const std::vector<std::pair<std::string, Search>>& searches) {
    Plot plot{
        .title = title, .x = {.label = "move", .lo = 0, .hi = 1, .whole = true}, .y = {.label = "F"}, .series = {}};
    for (std::size_t i = 0; i < searches.size(); ++i) {
        const auto& [name, search] = searches[i];
        // What lies on top of another curve is dashed, so that both are seen.
        PlotSeries series{.name = name, .color = curveColor(i), .dashed = i > 0, .dotted = true, .points = {}};
        for (std::size_t move = 0; move < search.objective.size(); ++move)
            series.points.push_back({static_cast<double>(move), search.objective[move]});
        plot.x.hi = std::max(plot.x.hi, series.points.back().x);
        plot.series.push_back(std::move(series));
    }
    plot.series.push_back({.name = "F = 0.03", .dashed = true, .points = {{0, kConverged}, {plot.x.hi, kConverged}}});
    fitLinear(plot, 1);
    return plot;
}

void drawPlot(Desk& desk, const std::string& name, const std::string& figure, const std::string& caption,
              const Plot& plot) {
    writeDrawing([&](const PlotPage& page) { return drawingOf(plot, page); }, {.width = 560, .height = 340},
                 desk.pathOf(desk.file(name)).string());
    desk.picture(desk.file(name), figure, caption);
}

std::string figuresText(const std::vector<double>& values) { return joined(values, ", ", figureText); }

} // namespace pellucid::cli
