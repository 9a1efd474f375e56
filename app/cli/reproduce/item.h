// An item of `reproduce`: a figure or table of the thesis, or some that belong together, as a short program over
// commands of pellucid-cli.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "report/reproduction.h"

namespace pellucid::cli {

class Desk;

/// Data that the thesis used for an item, and what stands for them.
struct DataNeed {
    std::string thesis;    ///< as the report calls them: "CT-Knee (379×229×305)"
    std::string sample;    ///< "knee", in `sample:knee`: where there is nothing else
    std::string real = {}; ///< below --data: "tooth/tooth.mhd"; empty: there are none
    bool isTheSame = true; ///< `real` is what the thesis used, not only alike
};

struct Item {
    std::vector<std::string>
        shows; ///< "3.4", "table-3.2", "section-5.4.2", "A.1": all that it does again; the first is its id
    std::string title;
    std::string thesis; ///< goes on after "The thesis shows ", to a full stop
    std::vector<ReproducedEquation> equations;
    std::vector<DataNeed> data;
    /// Runs commands at the desk and puts down what they show. Throws Error, Cancelled.
    std::function<void(Desk&)> run;
    bool timed = false; ///< measures times, so nothing else runs beside it

    const std::string& id() const { return shows.front(); }
    /// What is known of its result before it runs.
    Reproduction unmade() const;
};

/// What items of several chapters need and exercise.
inline const DataNeed kKnee{"CT-Knee (379×229×305)", "knee"};
inline const ReproducedEquation kVws{"4.12", "src/saliency/vws.cpp"}, kObjective{"5.1", "src/optimize/objective.cpp"};

/// In the order of the thesis: those of each chapter, and all.
std::vector<Item> itemsOfChapter3();
std::vector<Item> itemsOfChapter4();
std::vector<Item> itemsOfChapter5();
std::vector<Item> itemsOfSection5_4();
std::vector<Item> itemsOfChapter6();
std::vector<Item> itemsOfAppendixA();
const std::vector<Item>& items();

/// The items that show any of these, in the order of items(); all where `names` is empty. Throws UsageError for a name
/// that none shows.
std::vector<Item> itemsShowing(const std::vector<std::string>& names);

} // namespace pellucid::cli
