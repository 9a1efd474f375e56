// Transfer function optimization on one volume: figures 5.1 to 5.11 and table 5.1.
#include <algorithm>
#include <cmath>
#include <map>

#include "base/atomic_file.h"
#include "base/round_numbers.h"
#include "base/text.h"
#include "parse.h"
#include "reproduce/search_cases.h"
#include "threads_plot.h"

namespace pellucid::cli {

namespace {

// ---- The parameter space ------------------------------------------------------------------------------------------

/// VWS over the opacities of three features: the table that `space --csv` writes, f1 running fastest.
class SampledSpace {
public:
    explicit SampledSpace(const std::string& csv) {
        const std::vector<std::string> lines = split(csv, '\n');
        for (std::size_t i = 1; i < lines.size(); ++i) {
            if (lines[i].empty()) continue;
            const std::vector<std::string> cells = split(lines[i], ',');
            std::array<double, 3> vws{};
            for (std::size_t f = 0; f < 3; ++f)
                if (!parseNumber(cells.at(3 + f), vws[f]))
                    throw Error("a sample is no number: " + cells[3 + f], "space.csv", "run the item again");
            m_vws.push_back(vws);
        }
        m_side = static_cast<std::size_t>(std::lround(std::cbrt(static_cast<double>(m_vws.size()))));
    }
    std::size_t size() const { return m_vws.size(); }
    std::size_t side() const { return m_side; }

    /// How far W of `feature` goes up and down along lines in direction `axis`, on average over these.
    double meanRange(std::size_t feature, std::size_t axis) const {
        double sum = 0;
        forLines(feature, axis, [&](const std::vector<double>& line) {
            const auto [least, most] = std::ranges::minmax(line);
            sum += most - least;
        });
        return sum / static_cast<double>(m_side * m_side);
    }
    /// The deepest fall of a feature's W in a step of its own opacity; ≥ 0.
    double deepestFall(std::size_t feature) const {
        double deepest = 0;
        forLines(feature, feature, [&](const std::vector<double>& line) {
            for (std::size_t i = 1; i < line.size(); ++i) deepest = std::max(deepest, line[i - 1] - line[i]);
        });
        return deepest;
    }

private:
    template <class F>
    void forLines(std::size_t feature, std::size_t axis, const F& tell) const {
        const std::array<std::size_t, 3> strides{1, m_side, m_side * m_side};
        const std::size_t along = strides[axis], a = strides[(axis + 1) % 3], b = strides[(axis + 2) % 3];
        std::vector<double> line(m_side);
        for (std::size_t j = 0; j < m_side; ++j)
            for (std::size_t i = 0; i < m_side; ++i) {
                for (std::size_t k = 0; k < m_side; ++k) line[k] = m_vws[k * along + i * a + j * b][feature];
                tell(line);
            }
    }

    std::vector<std::array<double, 3>> m_vws;
    std::size_t m_side = 0;
};

/// §5.3.2 of the figure of three fields.
void sayHowVwsFollows(Desk& desk, const SampledSpace& space) {
    ReproducedTable table{"How much VWS rises and falls along one opacity, averaged over the other two",
                          {"VWS of", "along f1", "along f2", "along f3", "others / own"},
                          {}};
    std::array<double, 3> influence{};
    bool rises = true;
    std::vector<std::string> falls;
    for (std::size_t f = 0; f < 3; ++f) {
        const double own = space.meanRange(f, f),
                     others = space.meanRange(f, (f + 1) % 3) + space.meanRange(f, (f + 2) % 3);
        influence[f] = others / own;
        std::vector<std::string> row{"f" + std::to_string(f + 1)};
        for (std::size_t axis = 0; axis < 3; ++axis) row.push_back(figureText(space.meanRange(f, axis)));
        row.push_back(figureText(influence[f]));
        table.rows.push_back(row);
        rises = rises && own > 0 && space.deepestFall(f) < 0.01;
        falls.push_back(figureText(space.deepestFall(f)));
    }
    desk.table(std::move(table));
    desk.statement(
        "5.3.2", "The visibility-weighted saliency of each feature increases as its opacity increases.", rises,
        "over all " + std::to_string(space.size()) + " samples the deepest fall in a step is " + joined(falls));
    desk.statement("5.3.2", "That of feature 1, the exterior, is almost not influenced by the opacity of others.",
                   influence[0] < 0.1, "the others' influence is " + figureText(influence[0]) + " of its own",
                   "VWS values are shares of a whole, so that of the exterior falls when that of another feature "
                   "rises, although nothing covers the exterior.");
    desk.statement("5.3.2", "That of feature 2 is influenced by feature 1 and itself.",
                   space.meanRange(1, 0) > 0.1 && space.meanRange(1, 1) > 0.1 &&
                       space.meanRange(1, 2) < std::min(space.meanRange(1, 0), space.meanRange(1, 1)),
                   "along f1 " + figureText(space.meanRange(1, 0)) + ", along f2 " + figureText(space.meanRange(1, 1)) +
                       ", along f3 " + figureText(space.meanRange(1, 2)));
    desk.statement("5.3.2", "Feature 3, an interior structure, is influenced by the others most.",
                   influence[2] > influence[1] && influence[1] > influence[0],
                   "the others' influence divided by that of their own opacity: " +
                       figuresText({influence.begin(), influence.end()}));
}

/// §5.3.5 of the two paths.
void sayHowPathsGo(Desk& desk, const Json& space) {
    std::vector<std::string> texts;
    std::vector<double> moves;
    for (const Json& path : space.at("paths")) {
        moves.push_back(path.at("iterations"));
        texts.push_back(path.at("method").get<std::string>() + " " + std::to_string(path.at("iterations").get<int>()) +
                        " moves to F " + figureText(path.at("objective").back()));
    }
    desk.statement("5.3.5",
                   "With line search it takes fewer steps to reach a local minimum than with fixed step sizes.",
                   moves.at(1) < moves.at(0), joined(texts));
}

void parameterSpace(Desk& desk) {
    CaseAtDesk nucleon(desk, searchCases()[0], 0, {1 / 3.0, 1 / 3.0, 1 / 3.0}, "nucleon_naive.tfi");
    const Words measured = nucleon.measured() + Words{"--tf", nucleon.start()},
                drawn = nucleon.drawn() + Words{"--tf", nucleon.start()};
    desk.render("volume.png", "5.1 (a)", "the volume", drawn);
    desk.run(Words{"plot"} + nucleon.volume() + Words{"--tf", nucleon.start(), "--out", desk.file("tf.svg")});
    desk.picture(desk.file("tf.svg"), "5.1 (b)", "its transfer function of three features");
    desk.ask("measured", Words{"measure"} + measured + Words{"--bars", desk.file("bars.svg")});
    desk.picture(desk.file("bars.svg"), "5.1 (c), (d)", "feature visibility and VWS");

    const Words space = Words{"space"} + measured + Words{"--target", nucleon.of().targets};
    const std::string csv = desk.file("space.csv");
    for (int f = 1; f <= 3; ++f) {
        const std::string number = std::to_string(f);
        desk.run(space + Words{"--show", "f" + number, "--out", desk.file("w" + number + ".png")} +
                 (f == 1 ? Words{"--csv", csv} : Words{}));
        desk.picture(desk.file("w" + number + ".png"), f == 1 ? "5.2" : "",
                     "VWS of f" + number + " over the opacities");
    }
    desk.run(space + Words{"--out", desk.file("f.png")});
    desk.picture(desk.file("f.png"), "5.3", "F over the opacities, orange where it is high, blue where it is low");
    const Json paths = desk.ask("paths", space + Words{"--paths", "fixed,line", "--out", desk.file("paths.png")});
    desk.picture(desk.file("paths.png"), "5.5", "the steps of both methods");

    sayHowVwsFollows(desk, SampledSpace(readText(desk.pathOf(csv).string())));
    sayHowPathsGo(desk, paths);
    if (!nucleon.isTheThesiss())
        desk.remark("The sample is a core inside two shells, under tents of one opacity, in the thesis's colours.");
}

// ---- Directions of descent ----------------------------------------------------------------------------------------

constexpr std::array<const char*, 4> kDirections{"gradient", "backward", "second", "exact"};

/// Moves until F < 0.03 by every method along every direction.
void tellDirections(Desk& desk, std::vector<CaseAtDesk>& cases) {
    ReproducedTable table{"Moves (evaluations) until F < 0.03; – where it is not reached in 100 moves",
                          {"volume", "method", "gradient (method 1)", "backward", "second (method 2)", "exact"},
                          {}};
    for (CaseAtDesk& each : cases)
        for (const std::string method : kThesisMethods) {
            std::vector<std::string> row{each.of().name, method};
            for (const std::string direction : kDirections) {
                const Search search = each.search(each.of().name + "_" + method + "_" + direction, method,
                                                  {"--direction", direction, "--max-iterations", "100"});
                row.push_back(search.converged
                                  ? std::to_string(search.moves) + " (" + std::to_string(search.evaluations) + ")"
                                  : "–");
            }
            table.rows.push_back(row);
        }
    desk.table(std::move(table));
}

/// Of the moves that both make, those after which F differs by less than 0.02.
double overlapOf(const Search& a, const Search& b) {
    const std::size_t both = std::min(a.objective.size(), b.objective.size());
    std::size_t near = 0;
    for (std::size_t i = 0; i < both; ++i) near += std::abs(a.objective[i] - b.objective[i]) < 0.02;
    return static_cast<double>(near) / static_cast<double>(both);
}

/// Figure 5.4 of one volume: normalized directions, as the text has it.
void compareDirections(Desk& desk, CaseAtDesk& of, const std::string& figure) {
    const std::string& name = of.of().name;
    const auto along = [&](const std::string& direction) {
        return of.search(name + "_normalized_" + direction, "fixed",
                         {"--direction", direction, "--normalize", "--step", "0.02", "--max-iterations", "100"});
    };
    const Search first = along("gradient"), second = along("second");
    drawPlot(desk, name + ".svg", figure, "both directions on the " + name,
             objectivesPlot("Directions of descent, " + name, {{"method 1", first}, {"method 2", second}}));
    const double overlap = overlapOf(first, second);
    desk.statement("5.3.4", "The steps of the two methods overlap most of the time (" + name + ").", overlap > 0.5,
                   "F differs by less than 0.02 after " + fixedText(100 * overlap, 0) + " % of the moves, " +
                       std::to_string(first.moves) + " of method 1 and " + std::to_string(second.moves) +
                       " of method 2");
}

/// What becomes of each direction where steps are long: the last F, not the best one.
void sayWhatLongStepsDo(Desk& desk, std::vector<CaseAtDesk>& cases) {
    ReproducedTable table{"The last F, not the best one, with fixed steps of two lengths, after at most 150 moves",
                          {"volume", "step", "gradient (method 1)", "backward", "second (method 2)"},
                          {}};
    std::array<int, 3> small{}, large{};
    int volumes = 0;
    for (CaseAtDesk& each : cases)
        for (const std::string step : {"0.02", "0.2"}) {
            std::vector<std::string> row{each.of().name, step};
            for (std::size_t d = 0; d < 3; ++d) {
                const Search search =
                    each.search(each.of().name + "_step" + step + "_" + kDirections[d], "fixed",
                                {"--direction", kDirections[d], "--step", step, "--max-iterations", "150"});
                (step == "0.02" ? small : large)[d] += search.converged;
                row.push_back(figureText(search.last()));
            }
            table.rows.push_back(row);
            volumes += step == "0.02";
        }
    desk.table(std::move(table));
    const auto counts = [&](const std::array<int, 3>& of) {
        std::vector<std::string> texts;
        for (std::size_t d = 0; d < 3; ++d) texts.push_back(std::string(kDirections[d]) + " " + std::to_string(of[d]));
        return joined(texts);
    };
    const std::string of = " (of " + std::to_string(volumes) + "): ";
    desk.statement("5.3.4", "All the methods work with small step sizes.",
                   std::ranges::all_of(small, [&](int n) { return n == volumes; }),
                   "volumes on which steps of 0.02 end on target within 150 moves" + of + counts(small));
    desk.statement("5.3.4",
                   "As the step size increases the backward difference of W becomes unstable, the other two not.",
                   large[1] < volumes && large[0] == volumes && large[2] == volumes,
                   "volumes on which steps of 0.2 end on target" + of + counts(large));
}

void directions(Desk& desk) {
    std::vector<CaseAtDesk> cases;
    for (std::size_t i = 0; i < 2; ++i) cases.emplace_back(desk, searchCases()[i], i);
    compareDirections(desk, cases[0], "5.4 (a)");
    compareDirections(desk, cases[1], "5.4 (b)");
    tellDirections(desk, cases);
    sayWhatLongStepsDo(desk, cases);
    desk.remark("The thesis gives neither the starts nor the step sizes here. The starts are those of its table 5.1, "
                "or Pellucid's own. The plots use steps of 0.02, because longer steps along normalized directions "
                "oscillate around the goal.");
}

// ---- Line search and parallel line search -------------------------------------------------------------------------

double largestDifference(const Search& a, const Search& b) {
    if (a.objective.size() != b.objective.size()) return 1;
    double largest = 0;
    for (std::size_t i = 0; i < a.objective.size(); ++i)
        largest = std::max(largest, std::abs(a.objective[i] - b.objective[i]));
    return largest;
}

void twoSearches(Desk& desk) {
    const std::string parts = "abcd";
    for (std::size_t i = 0; i < searchCases().size(); ++i) {
        CaseAtDesk each(desk, searchCases()[i], i);
        const std::string& name = each.of().name;
        const Search line = each.search(name + "_line", "line"), parallel = each.search(name + "_parallel", "parallel");
        drawPlot(desk, name + ".svg", std::string("5.6 (") + parts[i] + ")", "F over the moves on the " + name,
                 objectivesPlot("Searches, " + name, {{"line search", line}, {"parallel line search", parallel}}));
        const double overlap = overlapOf(line, parallel);
        desk.statement("5.3.5",
                       "The curves of line search and parallel line search overlap most of the time (" + name + ").",
                       overlap > 0.5,
                       "F differs by less than 0.02 after " + fixedText(100 * overlap, 0) + " % of the moves, " +
                           std::to_string(line.moves) + " and " + std::to_string(parallel.moves) +
                           (largestDifference(line, parallel) < 1e-9 ? "; they make the same moves" : ""));
    }
}

// ---- Before and after ---------------------------------------------------------------------------------------------

/// What a figure shows beside the pictures, in the thesis's letters.
struct Letters {
    std::string before, tfBefore, barsBefore, after, tfAfter, barsAfter, curvesFixed, curvesParallel;
};

/// Picture, transfer function and bars.
std::vector<FeatureFigures> show(Desk& desk, const CaseAtDesk& of, const std::string& name, const std::string& tf,
                                 const std::string& highest, const std::array<std::string, 3>& figures) {
    desk.render(name + ".png", figures[0], name + " optimization", of.drawn() + Words{"--tf", tf});
    const std::string curve = desk.file(name + "_tf.svg"), bars = desk.file(name + "_bars.svg");
    desk.run(Words{"plot"} + of.volume() + Words{"--tf", tf, "--highest", highest, "--out", curve});
    desk.picture(curve, figures[1], "the transfer function " + name);
    const Json found = desk.ask(name, Words{"measure"} + of.measured() + Words{"--tf", tf, "--bars", bars});
    desk.picture(bars, figures[2], "feature visibility and VWS " + name);
    return featuresOf(found);
}

/// "For values of the energy function below 0.03, the SSIM scores settled consistently at over 0.99": from an answer
/// on, whose F is below that, to where nothing is gained any more.
void sayWhatIsImperceptible(Desk& desk, const CaseAtDesk& of, const std::string& answer) {
    const Json further = desk.ask("further", Words{"optimize"} + of.measured() +
                                                 Words{"--tf", answer, "--target", of.of().targets, "--method", "fixed",
                                                       "--tolerance", "0.002", "--max-iterations", "30", "--report",
                                                       desk.file("further"), "--report-size", "256x256"});
    const Json& threshold = further.at("report").at("threshold");
    const int states = threshold.at("states"), alike = threshold.at("alike");
    desk.statement("5.4", "For values of F below 0.03 the SSIM scores settled consistently at over 0.99.",
                   states > 0 && alike == states,
                   std::to_string(alike) + " of " + std::to_string(states) + " states with F below 0.03 have it" +
                       (states > 0 ? "; the least is " + fixedText(threshold.at("least"), 4) : ""));
}

/// §5.4 of what is inside. Where a feature had more than its target before, the targets ask for the contrary.
void sayWhatIsEmphasized(Desk& desk, const std::string& sentence, const std::vector<std::size_t>& emphasized,
                         const std::vector<FeatureFigures>& before, const std::vector<FeatureFigures>& after) {
    bool holds = true;
    std::vector<std::string> told;
    for (const std::size_t f : emphasized) {
        const bool rises = after.at(f).vws > before.at(f).vws;
        holds = holds && rises;
        told.push_back("VWS of " + after[f].name + " " + fromTo(before[f].vws, after[f].vws));
        if (!rises)
            desk.remark(after[f].name + " has a VWS of " + figureText(before[f].vws) +
                        " before the optimization, more than its target, so meeting the targets reduces it.");
    }
    desk.statement("5.4", sentence, holds, joined(told));
}

/// Figures 5.7 to 5.10.
void beforeAndAfter(Desk& desk, std::size_t number, const Letters& letters, const std::string& emphasis,
                    const std::vector<std::size_t>& emphasized) {
    CaseAtDesk of(desk, searchCases()[number], 0);
    const std::string figure = "5." + std::to_string(7 + number) + " ", after = desk.file("after.tf.json");
    const auto searched = [&](const std::string& method, const std::string& figures, const Words& more) {
        const std::string curves = desk.file(method + ".svg");
        Search search = of.search(method, method, more + Words{"--curves", curves, "--max-iterations", "100"});
        desk.picture(curves, figure + figures, "F, VWS and opacities over the moves, " + method);
        return search;
    };
    const std::vector<FeatureFigures> before =
        show(desk, of, "before", of.start(), "1",
             {figure + letters.before, figure + letters.tfBefore, figure + letters.barsBefore});
    const Search fixed = searched("fixed", letters.curvesFixed, {}),
                 parallel = searched("parallel", letters.curvesParallel, {"--out-tf", after});
    const std::vector<FeatureFigures> now = show(
        desk, of, "after", after, "1", {figure + letters.after, figure + letters.tfAfter, figure + letters.barsAfter});

    desk.statement("5.4", "The VWS of the features are very close to the user-specified targets.", parallel.converged,
                   "F " + fromTo(parallel.objective.front(), parallel.last()) + " by parallel line search, " +
                       fromTo(fixed.objective.front(), fixed.last()) + " by fixed steps");
    std::vector<double> covers;
    for (const FeatureFigures& f : now) covers.push_back(f.cover);
    desk.statement("5.4", "After optimization all the 3 features are visible.",
                   std::ranges::all_of(covers, [](double cover) { return cover >= 0.02; }),
                   "share that each covers of what lies behind it: " + figuresText(covers));
    sayWhatIsEmphasized(desk, emphasis, emphasized, before, now);
    sayWhatIsImperceptible(desk, of, after);
    if (!of.isTheThesiss())
        desk.remark(
            "The start is Pellucid's own: tents of equal width in the thesis's colours, with the peaks of table 5.1 "
            "(the vortex: equal peaks).");
}

Item optimized(std::size_t number, const std::string& title, const std::string& thesis, const Letters& letters,
               const std::string& emphasis, const std::vector<std::size_t>& emphasized) {
    return {{"5." + std::to_string(7 + number)},
            title,
            thesis,
            {kVws, kObjective},
            {searchCases()[number].data},
            [=](Desk& desk) { beforeAndAfter(desk, number, letters, emphasis, emphasized); }};
}

// ---- Times --------------------------------------------------------------------------------------------------------

/// As table 5.1 counts: evaluations of fixed steps, the start among them; moves of the others.
int stepsOf(const Search& search, std::size_t method) { return method == 0 ? search.evaluations : search.moves; }

void table51(Desk& desk) {
    constexpr std::array<const char*, 3> kNames{"fixed step size", "line search", "parallel line search"};
    bool fewer = true, same = true, exact = true, anyExact = false;
    double lineSeconds = 0, parallelSeconds = 0;
    std::vector<std::string> stepsTold, exactTold;
    for (std::size_t i = 0; i < searchCases().size(); ++i) {
        CaseAtDesk each(desk, searchCases()[i], i);
        std::array<Search, 3> found;
        std::array<int, 3> steps{};
        for (std::size_t m = 0; m < 3; ++m) {
            found[m] =
                each.search(each.of().name + "_" + kThesisMethods[m], kThesisMethods[m], {"--max-iterations", "200"});
            steps[m] = stepsOf(found[m], m);
            const PrintedSearch& printed = each.of().printed[m];
            desk.number(each.of().name + ", " + kNames[m], steps[m], printed.steps, "steps");
            desk.number(each.of().name + ", " + kNames[m], found[m].seconds, printed.seconds, "s");
            if (!each.isTheThesiss()) continue;
            anyExact = true;
            exact = exact && steps[m] == printed.steps;
        }
        const std::string told = each.of().name + " " + std::to_string(steps[0]) + ", " + std::to_string(steps[1]) +
                                 ", " + std::to_string(steps[2]);
        stepsTold.push_back(told);
        if (each.isTheThesiss()) exactTold.push_back(told);
        fewer = fewer && 2 * steps[1] <= steps[0] && 2 * steps[2] <= steps[0];
        same = same && largestDifference(found[1], found[2]) < 1e-9;
        lineSeconds += found[1].seconds;
        parallelSeconds += found[2].seconds;
    }
    if (anyExact)
        desk.statement("5.4", "The steps are those of table 5.1, on the thesis's volumes from its own starts.", exact,
                       joined(exactTold, "; "));
    desk.statement("5.4", "The two line search methods require much fewer steps than the fixed step size.", fewer,
                   joined(stepsTold, "; "));
    desk.statement("5.4", "They made the same choices of adaptive step sizes.", same,
                   same ? "after each move F is the same" : "F differs after some move");
    desk.statement("5.4", "The parallel line search is significantly faster than the sequential one.",
                   parallelSeconds < 0.8 * lineSeconds,
                   "all searches together take " + figureText(lineSeconds) + " s and " + figureText(parallelSeconds) +
                       " s",
                   "Here both searches use all threads in every evaluation, so the parallel search gains less.");
    desk.remark("Times are those of the search. Saliency does not change and is computed once beforehand.");
    if (!anyExact)
        desk.remark(
            "Without the thesis's data and starts (--data) the steps of its table cannot be met, only their order.");
}

void threadTimes(Desk& desk) {
    std::vector<BenchResult> rows;
    std::map<int, double> totals; // of all volumes, by number of threads
    std::vector<std::string> told;
    for (std::size_t i = 0; i < searchCases().size(); ++i) {
        CaseAtDesk each(desk, searchCases()[i], i);
        const std::string& name = each.of().name;
        const Json answer = desk.ask(name, Words{"bench"} + each.drawn() +
                                               Words{"--tf", each.start(), "--only", "threads", "--repeat", "3"});
        std::vector<double> seconds;
        for (const Json& row : answer.at("rows")) {
            BenchResult result;
            result.row = BenchRow::Threads;
            result.volume = name;
            result.threads = row.at("threads");
            result.seconds = row.at("seconds");
            seconds.push_back(result.seconds);
            totals[result.threads] += result.seconds;
            rows.push_back(result);
        }
        told.push_back(name + " " + figuresText(seconds));
    }
    drawPlot(desk, "threads.svg", "5.11", "seconds until F < 0.03 by number of threads", threadsPlot(rows));

    // Only threads that have a processor each can be faster than fewer.
    const int processors = processorCount();
    bool faster = true, levels = true;
    for (auto now = std::next(totals.begin()); now != totals.end(); ++now) {
        const double fewer = std::prev(now)->second;
        if (now->first <= processors)
            faster = faster && now->second < fewer;
        else
            levels = levels && now->second > 0.8 * fewer;
    }
    const std::string has =
        "this machine has " + std::to_string(processors) + (processors == 1 ? " processor" : " processors");
    desk.statement("5.4", "The computation time decreases as the number of threads increases.", faster,
                   "seconds with 1, 2, 4 and 8 threads: " + joined(told, "; ") + "; " + has);
    if (processors < totals.rbegin()->first)
        desk.statement("5.4", "The speedup is minor beyond the number of cores.", levels,
                       has + "; all volumes together: " +
                           joined(totals, ", ",
                                  [](const auto& total) {
                                      return std::to_string(total.first) +
                                             (total.first == 1 ? " thread " : " threads ") + figureText(total.second) +
                                             " s";
                                  }),
                       "Other programs ran on this machine at the same time: with more threads this one gets more of "
                       "the processors.");
}

} // namespace

std::vector<Item> itemsOfChapter5() {
    const std::vector<DataNeed> all = dataOf(searchCases());
    return {
        {{"5.1", "5.2", "5.3", "5.5"},
         "The parameter space of three opacities",
         "the nucleon with its transfer function and bars, the VWS of its three features and F over their opacities, "
         "in "
         "1331 samples, and the steps of fixed and adaptive step sizes.",
         {kVws, kObjective},
         {searchCases()[0].data},
         parameterSpace},
        {{"5.4"},
         "Directions of descent",
         "F over the moves along the gradient (method 1) and by second-order derivatives (method 2), on nucleon and "
         "tooth; "
         "most steps overlap.",
         {kObjective},
         {all[0], all[1]},
         directions},
        {{"5.6"},
         "Line search and parallel line search",
         "F over the moves of both searches on four volumes; the curves overlap, since they make the same choices.",
         {kObjective},
         all,
         twoSearches},
        optimized(0, "The nucleon, optimized", "three features, weak outside and strong inside; the targets are met.",
                  {"", "", "", "(a)", "(b)", "(c), (d)", "(e), (g)", "(f), (h)"},
                  "The green feature inside is particularly emphasized.", {2}),
        optimized(1, "The tooth, optimized", "the tooth before and after optimization to 0.1, 0.3, 0.6.",
                  {"(a)", "(b)", "(e), (f)", "(c)", "(d)", "(g), (h)", "(i), (k)", "(j), (l)"},
                  "The yellow feature inside is particularly emphasized.", {2}),
        optimized(2, "The CT-Knee, optimized", "the knee before and after optimization to 0.1, 0.3, 0.6.",
                  {"(a)", "(b)", "(e), (f)", "(c)", "(d)", "(g), (h)", "(i), (k)", "(j), (l)"},
                  "The green and the purple features inside become clearer.", {1, 2}),
        optimized(3, "The vortex, optimized", "the first time step before and after optimization to equal shares.",
                  {"(a)", "(b)", "(e), (f)", "(c)", "(d)", "(g), (h)", "(i), (k)", "(j), (l)"},
                  "The green feature inside is more emphasized than in the unoptimized result.", {2}),
        {{"table-5.1"},
         "Steps and seconds of three searches",
         "how many steps and seconds fixed steps, line search and parallel line search need to F < 0.03.",
         {kObjective},
         all,
         table51,
         true},
        {{"5.11"},
         "Time by number of threads",
         "the seconds that parallel line search needs on four volumes with 1, 2, 4 and 8 threads of a CPU of 4 cores.",
         {kObjective},
         all,
         threadTimes,
         true}};
}

} // namespace pellucid::cli
