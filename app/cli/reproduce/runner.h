// Items of `reproduce` side by side: each in a folder of its own, none twice for nothing.
#pragma once

#include <functional>
#include <span>
#include <stop_token>
#include <vector>

#include "reproduce/desk.h"

namespace pellucid::cli {

struct ItemOutcome {
    Reproduction result;   ///< with an error where the item failed
    bool isReused = false; ///< the result of an earlier call
};

/// Told of each item that ends, from any thread but one at a time: how many have ended.
using ItemsDone = std::function<void(std::size_t done)>;

/// Runs `items`, up to `sideBySide` of them at once (those that measure times alone, after the others); in their order.
/// An item whose folder holds a whole result of the same inputs is not run again. One that fails is told in its result,
/// and the others go on. Throws Cancelled where `stop` was requested; what was done by then stays.
std::vector<ItemOutcome> runItems(std::span<const Item> items, const DeskSettings& settings, int sideBySide,
                                  const std::stop_token& stop, const ItemsDone& tell = {});

/// The result in the item's folder; empty where there is none, it is of other inputs (another program, other data or
/// options), or a file of it is missing.
std::optional<Reproduction> keptResult(const Item& item, const DeskSettings& settings);

/// All results in the folder of the report that are of these inputs, in the order of items(); outcomes of this call in
/// their place.
std::vector<Reproduction> resultsAt(const DeskSettings& settings, std::span<const ItemOutcome> outcomes);

/// Makes the links to --data and the folder `thesis` beside it. Throws FileError.
void linkData(const DeskSettings& settings);

} // namespace pellucid::cli
