#include "reproduce/item.h"

#include <algorithm>

#include "base/error.h"
#include "base/text.h"

namespace pellucid::cli {

namespace {

bool shows(const Item& item, const std::string& name) {
    return std::ranges::find(item.shows, name) != item.shows.end();
}

} // namespace

Reproduction Item::unmade() const {
    Reproduction result;
    result.id = id();
    result.shows = shows;
    result.title = title;
    result.thesis = thesis;
    result.equations = equations;
    return result;
}

const std::vector<Item>& items() {
    static const std::vector<Item> all = [] {
        std::vector<Item> items;
        for (const auto& ofChapter :
             {itemsOfChapter3, itemsOfChapter4, itemsOfChapter5, itemsOfSection5_4, itemsOfChapter6, itemsOfAppendixA})
            for (Item& item : ofChapter()) items.push_back(std::move(item));
        return items;
    }();
    return all;
}

std::vector<Item> itemsShowing(const std::vector<std::string>& names) {
    for (const std::string& name : names) {
        if (std::ranges::any_of(items(), [&](const Item& item) { return shows(item, name); })) continue;
        std::vector<std::string> known;
        for (const Item& item : items()) known.insert(known.end(), item.shows.begin(), item.shows.end());
        throw UsageError("nothing is known that does '" + name + "' again", "ITEM", "give some of " + joined(known));
    }
    std::vector<Item> chosen;
    for (const Item& item : items())
        if (names.empty() || std::ranges::any_of(names, [&](const std::string& name) { return shows(item, name); }))
            chosen.push_back(item);
    return chosen;
}

} // namespace pellucid::cli
