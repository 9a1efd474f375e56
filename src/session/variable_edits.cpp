#include "session/variable_edits.h"

#include <algorithm>
#include <array>
#include <filesystem>

#include <glm/geometric.hpp>
#include <glm/matrix.hpp>

#include "base/error.h"
#include "base/text.h"
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

constexpr std::size_t kDeepest = 100; ///< derivations of derivations that are followed

/// Whether `text` is `name` or made of it. A damaged file may have variables that are made of themselves.
bool refersTo(const Session& session, std::string text, const std::string& name) {
    for (std::size_t depth = 0; depth < kDeepest; ++depth) {
        if (text == name) return true;
        const auto derivation = derivationOf(session, text);
        if (!derivation) return false;
        text = derivation->of;
    }
    return false;
}

/// The variable takes the place of the first one in the list, and that one its place.
void putFirst(Session& session, const std::string& name) {
    session.variables.edit([&](std::vector<Variable>& all) {
        std::iter_swap(all.begin(),
                       std::find_if(all.begin(), all.end(), [&](const Variable& v) { return v.name == name; }));
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

/// The name of the variable that is `derivation`, or is made so: channels that are driven by it are by that name then.
std::string variableOf(Session& session, const Derivation& derivation) {
    const auto made = std::find_if(
        session.variables->begin(), session.variables->end(),
        [text = derivation.text()](const Variable& v) { return v.derivation && v.derivation->text() == text; });
    std::string name;
    if (made != session.variables->end()) {
        name = made->name;
    } else {
        Variable variable;
        variable.name = titleOf(derivation);
        variable.derivation = derivation;
        name = addVariable(session, std::move(variable));
    }
    editChannels(session, [&, text = derivation.text()](std::string& driver) {
        if (driver == text) driver = name;
    });
    return name;
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

void requireVariable(const Session& session, std::string name) {
    for (std::size_t depth = 0; session.variableNamed(name) == nullptr && depth < kDeepest; ++depth) {
        const auto derivation = parseDerivation(name);
        if (!derivation)
            throw UsageError("there is no variable '" + name + "'", "",
                             "the variables are " + joined(*session.variables, ", ", &Variable::name));
        name = derivation->of;
    }
}

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
        const std::string first = session.variable().name;
        std::string wanted = name;
        if (session.variableNamed(name) == nullptr) {
            const auto derivation = parseDerivation(name);
            if (!derivation) return;
            wanted = variableOf(session, *derivation);
        }
        renameInChannels(session, [&](const std::string& driver) {
            return driver == first ? wanted : driver == wanted ? first : driver;
        });
        return putFirst(session, wanted);
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

void setFeaturesOf(Session& session, const std::string& name) {
    if (session.variableNamed(name) != nullptr) return putFirst(session, name);
    requireVariable(session, name);
    putFirst(session, variableOf(session, *parseDerivation(name)));
}

std::string featuresOf(const Session& session, const std::string& text) {
    if (session.variableNamed(text) != nullptr) return text;
    const std::string of = ":" + dataVariable(session).name;
    if (text == "gradient") return text + of;
    for (const std::string kind : {"volatility:", "difference:"}) {
        std::int64_t number = 0;
        if (text.starts_with(kind) && parseNumber(text.substr(kind.size()), number))
            return text.substr(0, kind.size() - 1) + of + ":" + text.substr(kind.size());
    }
    return text;
}

const Variable& dataVariable(const Session& session) {
    std::string name = session.variable().name;
    for (std::size_t depth = 0; depth < kDeepest; ++depth) {
        const Variable* const variable = session.variableNamed(name);
        if (variable != nullptr && !variable->derivation) return *variable;
        const auto derivation = derivationOf(session, name);
        if (!derivation) break;
        name = derivation->of;
    }
    return session.variable(); // made of nothing that there is: resolving it tells
}

void setDataSource(Session& session, const VolumeSource& source) {
    const std::string name = dataVariable(session).name;
    session.variables.edit([&](std::vector<Variable>& all) {
        for (Variable& v : all)
            if (v.name == name) v.source = source;
    });
}

namespace {

/// Of the sources of all variables that are not made of others.
template <class T>
void setOfSources(Session& session, std::optional<T> VolumeSource::*member, const std::optional<T>& value) {
    session.variables.edit([&](std::vector<Variable>& all) {
        for (Variable& v : all)
            if (!v.derivation) v.source.*member = value;
    });
}

} // namespace

void setDataAxes(Session& session, const std::optional<GridAxes>& axes) {
    setOfSources(session, &VolumeSource::axes, axes);
}
void setDataSpacing(Session& session, const std::optional<GridSpacing>& spacing) {
    setOfSources(session, &VolumeSource::spacing, spacing);
}

void placeData(Session& session, const Volume& volume, const std::optional<GridAxes>& axes,
               const std::optional<GridSpacing>& spacing) {
    const Volume after = withPlacement(volume, axes, spacing);
    setDataAxes(session, axes);
    setDataSpacing(session, spacing);
    const Mat3 turn = after.geometry().worldFromIndex() * volume.geometry().indexFromWorld();
    const auto moved = [&](const Vec3& world) {
        return after.geometry().worldFromVoxel(volume.geometry().voxelFromWorld(world));
    };
    if (!session.rulers->empty())
        session.rulers.edit([&](std::vector<Ruler>& rulers) {
            for (Ruler& ruler : rulers) {
                for (Vec3& point : ruler.points) point = moved(point);
                if (ruler.kind == RulerKind::Box)
                    ruler.points = boxRuler(ruler.points.front(), ruler.points.back()).points;
            }
        });
    const auto movePlanes = [&](Clipping& clipping) {
        for (std::vector<ClipPlane>* planes : {&clipping.planes, &clipping.rest.within.planes})
            for (ClipPlane& plane : *planes) {
                const Vec3 on = moved(plane.normal * (plane.offset / glm::dot(plane.normal, plane.normal)));
                const Vec3 normal = glm::transpose(glm::inverse(turn)) * plane.normal;
                plane.normal = normal * (glm::length(plane.normal) / glm::length(normal));
                plane.offset = glm::dot(plane.normal, on);
            }
    };
    const auto moveCamera = [&](Camera& camera) {
        camera = cameraOfSpaced(camera, volume.geometry(), after.geometry());
    };
    session.clipping.edit(movePlanes);
    if (!session.keyframes->empty())
        session.keyframes.edit([&](Keyframes& keys) {
            for (Keyframe& key : keys) {
                moveCamera(key.state.camera);
                movePlanes(key.state.clipping);
            }
        });
    if (session.comparison->b)
        session.comparison.edit([&](ComparisonView& view) {
            if (view.b->camera) moveCamera(*view.b->camera);
            view.b->clipping.edit(movePlanes);
        });
}

Camera cameraOfSpaced(const Camera& camera, const Geometry& before, const Geometry& after) {
    if (before.spacing == after.spacing) return camera;
    Camera moved = camera;
    const double scale = after.radius() / before.radius();
    moved.center = after.worldFromVoxel(before.voxelFromWorld(camera.center));
    moved.eye = moved.center + scale * (camera.eye - camera.center);
    moved.height *= scale;
    return moved;
}

std::optional<int> featureFrames(const Session& session) {
    const auto& derivation = session.variable().derivation;
    if (!derivation || derivation->kind != Derivation::Kind::Volatility) return {};
    return derivation->frames;
}

void takeTfParts(Session& session, const TransferFunction& other, const TfParts& parts, const ValueRange& window) {
    TransferFunction now = *session.tf();
    if (!now.range && window.lo < window.hi) now.range = window;
    if (!now.range && !other.range) return; // constant data: no two values
    TransferFunction made = withParts(now, other, parts);
    if (parts.range && made.range)
        session.variables.edit([&](std::vector<Variable>& all) { all.front().window = made.range; });
    session.setTf(std::move(made));
}

void setFeatureFrames(Session& session, int frames) {
    if (featureFrames(session))
        session.variables.edit([frames](std::vector<Variable>& all) { all.front().derivation->frames = frames; });
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
