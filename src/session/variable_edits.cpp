#include "session/variable_edits.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include "base/error.h"
#include "session/scene_data.h"

namespace pellucid {
namespace {

/// How the variable of this name, or what is written like one, is made; empty: it is not derived.
std::optional<Derivation> derivationOf(const Session& session, const std::string& name) {
    if (const Variable* variable = session.variableNamed(name)) return variable->derivation;
    return parseDerivation(name);
}

using Rename = std::function<std::string(const std::string&)>;

/// `text` with the variable that it names, or is made of, under another name.
std::string renamedIn(const Session& session, const std::string& text, const Rename& rename) {
    if (text.empty()) return text;
    if (session.variableNamed(text) == nullptr)
        if (auto derivation = parseDerivation(text)) {
            derivation->of = renamedIn(session, derivation->of, rename);
            return derivation->text();
        }
    return rename(text);
}

/// What drives colours, channel by channel.
constexpr std::array kDriven{&HsbMapping::saturation, &HsbMapping::brightness, &HsbMapping::hue};

/// `change(driver)` for each of them.
template <class Change>
void editChannels(Session& session, const Change& change) {
    session.hsb.edit([&](HsbMapping& hsb) {
        for (const auto channel : kDriven) change(hsb.*channel);
    });
}

void renameInChannels(Session& session, const Rename& rename) {
    editChannels(session, [&](std::string& driver) { driver = renamedIn(session, driver, rename); });
}

/// Whether `text` is `name` or made of it. A damaged file may have variables that are made of themselves.
bool refersTo(const Session& session, std::string text, const std::string& name) {
    for (std::size_t depth = 0; depth < 100; ++depth) {
        if (text == name) return true;
        const auto derivation = derivationOf(session, text);
        if (!derivation) return false;
        text = derivation->of;
    }
    return false;
}

void exchange(Session& session, const std::string& a, const std::string& b) {
    if (a == b) return;
    renameInChannels(session, [&](const std::string& name) { return name == a ? b : name == b ? a : name; });
    session.variables.edit([&](std::vector<Variable>& all) {
        const auto find = [&](const std::string& name) {
            return std::find_if(all.begin(), all.end(), [&](const Variable& v) { return v.name == name; });
        };
        std::iter_swap(find(a), find(b));
    });
}

/// A name for people: "volatility of x".
std::string titleOf(const Derivation& d) {
    switch (d.kind) {
    case Derivation::Kind::Gradient:
        return "gradient of " + d.of;
    case Derivation::Kind::Volatility:
        return "volatility of " + d.of;
    case Derivation::Kind::Difference:
        return "change of " + d.of;
    }
    return d.of;
}

/// Of the channels' volatility: its text, or the variable that it is.
std::string* volatilityIn(const Session& session, HsbMapping& hsb) {
    for (const auto channel : kDriven) {
        std::string& driver = hsb.*channel;
        if (driver.empty()) continue;
        const auto derivation = derivationOf(session, driver);
        if (derivation && derivation->kind == Derivation::Kind::Volatility) return &driver;
    }
    return nullptr;
}

} // namespace

std::string freeVariableName(const Session& session, const std::string& wish) {
    std::string name = wish;
    std::replace(name.begin(), name.end(), ':', ' ');
    if (name.empty()) name = "x";
    const std::string stem = name;
    for (int number = 2; session.variableNamed(name) != nullptr; ++number) name = stem + " " + std::to_string(number);
    return name;
}

std::string nameOfSource(const VolumeSource& source) {
    if (!source.array.empty()) return source.array;
    if (source.isSample()) return source.path.substr(source.path.find_last_of(":/") + 1);
    std::string name = std::filesystem::path(source.path).filename().string();
    // Up to the first dot, wildcard or conversion; then without what tells frames apart.
    const std::string stem = name.substr(0, name.find_first_of(".%*?[", 1));
    const std::size_t end = stem.find_last_not_of("0123456789_- ");
    return end == std::string::npos ? (stem.empty() ? name : stem) : stem.substr(0, end + 1);
}

std::vector<std::string> madeOf(const Session& session, const std::string& name) {
    std::vector<std::string> names;
    for (const Variable& v : *session.variables)
        if (v.name != name && refersTo(session, v.name, name)) names.push_back(v.name);
    return names;
}

std::string addVariable(Session& session, Variable variable) {
    variable.name = freeVariableName(session, variable.name);
    std::string name = variable.name;
    session.variables.edit([&](std::vector<Variable>& all) { all.push_back(std::move(variable)); });
    return name;
}

void renameVariable(Session& session, const std::string& from, const std::string& to) {
    if (from == to) return;
    if (to.empty() || to.find(':') != std::string::npos)
        throw UsageError("a variable cannot be called this", "\"" + to + "\"", "give a name without colons");
    if (session.variableNamed(to) != nullptr)
        throw UsageError("another variable has this name", to, "choose another one");
    const Rename rename = [&](const std::string& name) { return name == from ? to : name; };
    std::vector<Variable> renamed = *session.variables;
    for (Variable& v : renamed) {
        v.name = rename(v.name);
        if (v.derivation) v.derivation->of = renamedIn(session, v.derivation->of, rename);
    }
    renameInChannels(session, rename);
    session.variables.set(std::move(renamed));
}

void removeVariable(Session& session, const std::string& name) {
    if (session.variables->size() < 2) throw UsageError("the last variable cannot be removed", name, "open other data");
    if (const auto others = madeOf(session, name); !others.empty())
        throw UsageError("variable " + others.front() + " is made of it", name, "remove that one first");
    editChannels(session, [&](std::string& driver) {
        if (refersTo(session, driver, name)) driver.clear();
    });
    session.variables.edit(
        [&](std::vector<Variable>& all) { std::erase_if(all, [&](const Variable& v) { return v.name == name; }); });
}

namespace {

/// Of a channel that colours, not of opacity.
std::string HsbMapping::*driverOf(Channel channel) {
    return channel == Channel::Saturation   ? &HsbMapping::saturation
           : channel == Channel::Brightness ? &HsbMapping::brightness
                                            : &HsbMapping::hue;
}

} // namespace

std::string channelOf(const Session& session, Channel channel) {
    if (channel == Channel::Opacity) return session.isEmpty() ? "" : session.variable().name;
    return (*session.hsb).*driverOf(channel);
}

void setChannel(Session& session, Channel channel, const std::string& name) {
    if (channel == Channel::Opacity) {
        std::string wanted = name;
        if (session.variableNamed(name) == nullptr) {
            const auto derivation = parseDerivation(name);
            if (!derivation) return;
            Variable variable;
            variable.name = titleOf(*derivation);
            variable.derivation = derivation;
            wanted = addVariable(session, std::move(variable));
            editChannels(session, [&](std::string& driver) {
                if (driver == name) driver = wanted;
            });
        }
        return exchange(session, session.variable().name, wanted);
    }
    session.hsb.edit([&](HsbMapping& hsb) { hsb.*driverOf(channel) = name; });
}

void swapOpacityAndBrightness(Session& session) {
    if (const std::string other = session.hsb->brightness; !other.empty()) setChannel(session, Channel::Opacity, other);
}

std::string definitionOf(const Session& session, const Derivation& derivation) {
    const std::string &of = derivation.of, frames = std::to_string(derivation.frames);
    const bool published = volatilityKind(session) == VolatilityKind::Published;
    switch (derivation.kind) {
    case Derivation::Kind::Gradient:
        return "magnitude of the gradient of " + of + ", scaled to 0 to 1 over the series, per d0";
    case Derivation::Kind::Volatility:
        return published ? "sample standard deviation of " + of + ", each frame scaled to 0 to 1, over the latest " +
                               frames + " frames, stretched to 0 to 1 (published profile)"
                         : "population standard deviation of " + of + ", scaled to 0 to 1 over the series, over the " +
                               "latest " + frames + " frames";
    case Derivation::Kind::Difference:
        return of + " less its values in frame " + std::to_string(derivation.reference) + ", in data units";
    }
    return {};
}

std::optional<int> volatilityFrames(const Session& session) {
    HsbMapping hsb = *session.hsb;
    const std::string* text = volatilityIn(session, hsb);
    if (text == nullptr) return {};
    const auto derivation = derivationOf(session, *text);
    return derivation->frames;
}

void setVolatilityFrames(Session& session, int frames) {
    HsbMapping hsb = *session.hsb;
    std::string* text = volatilityIn(session, hsb);
    if (text == nullptr) return;
    if (session.variableNamed(*text) != nullptr) {
        session.variables.edit([&](std::vector<Variable>& all) {
            for (Variable& v : all)
                if (v.name == *text) v.derivation->frames = frames;
        });
    } else {
        Derivation derivation = *parseDerivation(*text);
        derivation.frames = frames;
        *text = derivation.text();
        session.hsb.set(hsb);
    }
}

void startMapping(Session& session, bool varies) {
    HsbMapping hsb = *session.hsb;
    if (!hsb.saturation.empty() || !hsb.brightness.empty() || !hsb.hue.empty()) return;
    if (varies) {
        Derivation volatility;
        volatility.kind = Derivation::Kind::Volatility;
        volatility.of = session.variable().name;
        hsb.saturation = volatility.text();
    }
    if (session.variables->size() > 1) hsb.brightness = (*session.variables)[1].name;
    session.hsb.set(hsb);
}

} // namespace pellucid
