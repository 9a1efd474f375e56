#include "controllers/refine_controller.h"

#include <algorithm>
#include <cmath>

#include <QScopedValueRollback>

#include "controllers/optimize_controller.h"
#include "jobs/rest_timer.h"
#include "optimize/coverage.h"
#include "optimize/refine/drawn_colors.h"
#include "optimize/refine/refine_features.h"
#include "optimize/refine/refine_live.h"
#include "optimize/refine/refine_words.h"
#include "optimize/refine/region_colors.h"
#include "services/services.h"
#include "session/refine_priority.h"
#include "store/edits.h"

namespace pellucid::gui {
namespace {

constexpr std::size_t kMostKept = 64;    // refinements that undo and redo find again
constexpr std::size_t kMostRegions = 16; // whose colours are kept
constexpr int kLookSize = 320;           // pixels along the longer side of the picture that a region is taken from

Run runOf(const Refinement& refinement) {
    Run run;
    run.kind = "refine";
    run.ended = "done";
    for (const Feature& f : refinement.after.features) run.features.push_back(f.name);
    run.before = refinement.result.energyMovableBefore;
    run.after = refinement.result.energyMovableAfter;
    run.iterations = refinement.result.iterations;
    return run;
}

} // namespace

QString evennessText(double energyBefore, double energyAfter) {
    if (!(energyAfter > 0) || energyBefore / energyAfter > 1e6) return QObject::tr("edge weights all but equal");
    const double ratio = energyBefore / energyAfter;
    return QObject::tr("the edges weigh %1 times more evenly")
        .arg(ratio < 100 ? QString::number(ratio, 'g', 3) : QStringLiteral("%L1").arg(std::lround(ratio)));
}

RefineController::RefineController(Services& services, OptimizeController& optimizing)
    : m_services(services), m_optimizing(optimizing), m_renderer(std::make_shared<KeptRenderer>()),
      m_look(
          [renderer = m_renderer](const Look& look, const JobControl& job) {
              return regionColors(renderer->render(look.picture, job), look.region);
          },
          [this](const Look& look, std::vector<RegionColor>& colors) {
              std::erase_if(m_colors, [&](const auto& known) { return known.first == look.region; });
              m_colors.emplace_back(look.region, std::move(colors));
              if (m_colors.size() > kMostRegions) m_colors.pop_front();
              m_pending.reset();
              refineForRegion(look);
          }),
      m_examine(
          [](const Examined& task, const JobControl& job) -> std::optional<Darkening> {
              const Scene& scene = task.scene;
              const Refinement& r = task.refinement;
              const RayBundle rays(*scene.volume, r.before, measureInput(scene).view, kCoverageRays, job);
              return darkeningOf(rays, *scene.histogram, r.before, r.after, r.options, [&](const RefineOptions& by) {
                  return withOpacitiesOf(
                      r.before,
                      refineAsDrawn(*scene.histogram, r.start, *scene.volume, scene.colors.get(), by, job).tf);
              });
          },
          [this](const Examined& task, std::optional<Darkening>& dark) {
              if (!dark) return;
              for (Refinement& r : m_kept)
                  if (r.volume == task.refinement.volume && r.after == task.refinement.after) r.dark = dark;
              // Of another state, that was undone meanwhile, say, nothing is said.
              if (const Refinement* now = current(); now != nullptr && now->after == task.refinement.after)
                  say(QString::fromStdString(darkeningText(*dark)));
              Q_EMIT refined();
          }) {
    services.store().setConsequence(
        [this](const Scene& before, const Scene& after, Session& session) { return follow(before, after, session); });
    connect(&m_look, &JobBase::busyChanged, this, &RefineController::busyChanged);
    connect(&m_look, &JobBase::cancelled, this, [this] { m_pending.reset(); });
    connect(&m_look, &JobBase::failed, this, [this](const Error& error) {
        m_pending.reset();
        say(tr("The region was not taken: %1 (%2).")
                .arg(QString::fromStdString(error.problem()), QString::fromStdString(error.whatToDo())));
        Q_EMIT busyChanged();
    });
    connect(&services.store(), &SessionStore::historyChanged, this, [this] {
        if (m_services.store().isPreviewing()) return;
        m_latestIsPreview = false;
        m_dragStart.reset(); // whoever has ended the preview has ended the drag
        examine();
    });
    connect(&services.store(), &SessionStore::changed, this, [this](const Scene& before, const Scene& after) {
        if (before.volume != after.volume) {
            m_look.cancel();
            m_examine.cancel();
            m_dragStart.reset();
            m_renderer->release();
            std::erase_if(m_kept, [&](const Refinement& r) { return r.volume != after.volume; });
            if (before.data != after.data) m_colors.clear();
        }
        if (!(before.tf == after.tf)) Q_EMIT refined();
    });
}

RefineController::~RefineController() { m_services.store().setConsequence({}); }

void RefineController::addActions() {
    Actions& actions = m_services.actions();
    ActionMenu menu(actions, tr("&Transfer function"), [this] { return m_services.isEditable(); });
    const auto settings = [this]() -> const RefineSettings& { return *m_services.store().session().refine; };
    menu.separate();
    m_actions.refine =
        menu.add("refineAction", tr("&Refine by entropy"), "Ctrl+R",
                 tr("Sets opacities by entropy: common values get less, rare ones more; with a priority, "
                    "what is like it gets more"),
                 [this] { refine(); });
    const auto toggleLive = [this] {
        m_services.store().edit(tr("Live refinement"), {}, [](Session& session) {
            session.refine.edit([](RefineSettings& r) { r.live = !r.live; });
            if (session.refine->live) session.holdTargets = false; // both set opacities
        });
    };
    m_actions.live = menu.addCheck(
        "liveRefineAction", tr("Refine &live"), {},
        tr("Refine after every edit; what you move stays where you put it, the other points "
           "give way"),
        [settings] { return settings().live; }, toggleLive);
    const auto select = [&](const char* id, const QString& text, const char* keys, const QString& tip, Selecting what) {
        return menu.addCheck(
            id, text, keys, tip, [this, what] { return m_selecting == what; },
            [this, what] { setSelecting(m_selecting == what ? Selecting::Nothing : what); }, true);
    };
    m_actions.rectangle =
        select("rectangleAction", tr("Select re&ctangle"), "Shift+R",
               tr("Draw a rectangle in the picture: what has its colours becomes more opaque, everything else less"),
               Selecting::Rectangle);
    m_actions.lasso =
        select("lassoAction", tr("Select with la&sso"), "Shift+L",
               tr("Draw round a part of the picture: what has its colours becomes more opaque, everything else less"),
               Selecting::Lasso);
    m_actions.nothing =
        menu.add("prioritizeNothingAction", tr("Clear priorit&y"), {},
                 tr("Forget the intensity or region that refinement brings out; opacities stay"),
                 [this] { prioritizeNothing(); },
                 {.enabled = [this, settings] { return m_services.isEditable() && settings().favoursAny(); }});
    m_actions.ghost = actions.add(tr("&Transfer function"), "ghostAction", tr("Show the &curve before the refinement"),
                                  {}, tr("Behind the curve: what it was before the latest refinement"),
                                  [this] { setGhostShown(!m_ghost); }, {}, {.checked = [this] { return m_ghost; }});
    m_actions.pair = menu.add("sideBySideAction", tr("Before and after, side by &side…"), {},
                              tr("The picture before and after the latest refinement, from the present camera"),
                              [this] { Q_EMIT pairWanted(); },
                              {.enabled = [this] { return m_services.store().hasVolume() && latest() != nullptr; }});
    connect(this, &RefineController::refined, &actions, &Actions::refresh);
    connect(this, &RefineController::selectingChanged, &actions, &Actions::refresh);
    const QString volume = tr("Volume");
    actions.addGestures({{volume, tr("Drag a corner, an edge or the inside of a selection"), tr("change it, move it")},
                         {volume, tr("Delete or Esc, with a selection"), tr("remove it")}});
}

const std::vector<RegionColor>* RefineController::colorsOf(const ImageRegion& region) const {
    for (const auto& [known, colors] : m_colors)
        if (known == region) return &colors;
    return nullptr;
}

std::optional<RefinePriority> RefineController::priorityOf(const Scene& scene) const {
    const RefineSettings& settings = *scene.session.refine;
    RefinePriority priority;
    priority.intensity = settings.intensity;
    if (settings.hue) {
        // Where colours are drawn that are not the transfer function's, every voxel is looked at.
        if (m_hue.hue != settings.hue || m_hue.tf != scene.tf || m_hue.volume.lock() != scene.volume ||
            m_hue.colors.lock() != scene.colors)
            m_hue = {*settings.hue, scene.tf, scene.volume, scene.colors, huePriority(scene, scene.tf, *settings.hue)};
        return m_hue.priority;
    }
    if (settings.region) {
        const auto* colors = colorsOf(*settings.region);
        if (colors == nullptr) return {};
        priority.region = *colors;
    }
    return priority;
}

RefineOptions RefineController::options() const {
    const Scene& scene = m_services.scene();
    RefineOptions options = refineOptions(scene.session);
    try {
        options.priority = priorityOf(scene).value_or(RefinePriority());
    } catch (const Error&) { // no colour has a hue: who refines is told
    }
    return options;
}

const Refinement* RefineController::current() const {
    const Scene& scene = m_services.scene();
    for (auto r = m_kept.rbegin(); r != m_kept.rend(); ++r)
        if (r->volume == scene.volume && !refinesOtherwise(r->after, scene.tf, true)) return &*r;
    return nullptr;
}

const Refinement* RefineController::latest() const {
    if (const Refinement* now = current()) return now;
    return m_kept.empty() || m_kept.back().volume != m_services.scene().volume ? nullptr : &m_kept.back();
}

TransferFunction RefineController::startOfPriority() const {
    const Refinement* now = current();
    return now != nullptr && now->options.priority.any() ? now->before : m_services.scene().tf;
}

Refinement RefineController::refineFrom(const TransferFunction& before, const TransferFunction& start,
                                        const Scene& scene, RefineOptions options) const {
    Refinement r{scene.volume, before, {}, start, std::move(options), {}, {}, {}, {}};
    // A few milliseconds, of the histogram alone: no reason to go to another thread.
    const auto refineBy = [&](const RefineOptions& by) {
        return refineAsDrawn(*scene.histogram, r.start, *scene.volume, scene.colors.get(), by);
    };
    r.result = refineBy(r.options);
    r.after = withOpacitiesOf(before, r.result.tf);
    const auto outcome = priorityOutcome(
        *scene.histogram,
        r.options.priority.region.empty() ? before : withDrawnColors(before, *scene.volume, scene.colors.get()),
        r.after, r.options, [&](const RefineOptions& by) { return refineBy(by).tf; });
    if (outcome) r.shortfall = QString::fromStdString(outcome->text);
    r.words = QString::fromStdString(changeText(opacityChanges(r.before, r.after)));
    return r;
}

void RefineController::keep(Refinement refinement) {
    if (m_latestIsPreview && !m_kept.empty()) m_kept.pop_back();
    m_latestIsPreview = m_services.store().isPreviewing();
    m_kept.push_back(std::move(refinement));
    if (m_kept.size() > kMostKept) m_kept.pop_front();
}

void RefineController::say(const QString& text) {
    m_optimizing.say(text);
    Q_EMIT m_services.message(text);
}

void RefineController::sayRefined(const Refinement& refinement) {
    QString text = tr("Refinement found nothing to improve.");
    if (!(refinement.after == refinement.before))
        text = tr("Refined: %1; %2.")
                   .arg(refinement.words,
                        evennessText(refinement.result.energyMovableBefore, refinement.result.energyMovableAfter));
    if (refinement.options.profile == Profile::Published) text += ' ' + tr("By the published definitions.");
    if (!refinement.shortfall.isEmpty()) text += ' ' + refinement.shortfall;
    say(text);
}

void RefineController::examine() {
    const Refinement* now = current();
    if (now == nullptr || !m_services.scene().histogram || m_examined == now->after) return;
    m_examined = now->after;
    m_examine.start({m_services.scene(), *now}, tr("the picture of the refinement"));
}

void RefineController::takeHelp() {
    const Refinement* now = current();
    if (!m_services.isEditable() || now == nullptr || !now->dark || now->dark->help == Darkening::Help::None) return;
    const auto change = [exact = now->dark->help == Darkening::Help::Exact,
                         iterations = now->dark->iterations](auto& settings) {
        if (exact)
            settings.method = RefineMethod::Exact;
        else
            settings.maxIterations = iterations;
    };
    RefineOptions by = now->options;
    change(by);
    m_services.attempt(tr("Refinement failed"), [&] {
        const Refinement r = refineFrom(now->before, now->start, m_services.scene(), by);
        apply(r, tr("Refine, keeping the picture visible"), change);
    });
}

void RefineController::refine() {
    SessionStore& store = m_services.store();
    if (!m_services.isEditable() || !store.scene().histogram) return;
    store.commit();
    m_services.attempt(tr("Refinement failed"), [&] {
        const std::optional<RefinePriority> priority = priorityOf(store.scene());
        if (!priority) return look(*store.session().refine->region, tr("Refine"));
        RefineOptions by = refineOptions(store.session());
        by.priority = *priority;
        const Refinement r = refineFrom(store.scene().tf, store.scene().tf, store.scene(), by);
        r.after == r.before ? sayRefined(r) : apply(r, tr("Refine"), {});
    });
}

void RefineController::apply(const Refinement& r, const QString& text,
                             const std::function<void(RefineSettings&)>& change) {
    const QScopedValueRollback quiet(m_quiet, true);
    keep(r);
    m_services.store().edit(text, {}, [&](Session& session) { put(r, change, session); });
    sayRefined(r);
}

void RefineController::put(const Refinement& r, const std::function<void(RefineSettings&)>& change, Session& session) {
    if (change) session.refine.edit(change);
    session.setTf(r.after);
    session.addRun(runOf(r));
}

void RefineController::prioritize(double x, const QString& mergeKey) {
    if (!m_services.isEditable() || m_dragStart) return;
    dragPriority(x);
    m_dragStart.reset();
    m_services.store().commit(mergeKey);
    if (const Refinement* now = current()) sayRefined(*now);
}

void RefineController::dragPriority(double x) {
    SessionStore& store = m_services.store();
    if (!m_services.isEditable() || !store.scene().histogram) return;
    if (!m_dragStart) {
        store.commit();
        m_dragStart = startOfPriority();
    }
    const bool good = m_services.attempt(tr("Refinement failed"), [&] {
        RefineOptions by = refineOptions(store.session());
        by.priority.intensity = std::clamp(x, 0.0, 1.0);
        const Refinement r = refineFrom(*m_dragStart, *m_dragStart, store.scene(), by);
        const auto change = [&](RefineSettings& s) {
            s.favourNothing();
            s.intensity = by.priority.intensity;
        };
        const QScopedValueRollback quiet(m_quiet, true);
        store.preview(tr("Refine for an intensity"), [&](Session& session) { put(r, change, session); });
        keep(r);
        Q_EMIT refined();
    });
    if (!good) cancelDrag();
}

void RefineController::endDrag() {
    if (!m_dragStart) return;
    m_dragStart.reset();
    m_services.store().commit();
    if (const Refinement* now = current()) sayRefined(*now);
}

void RefineController::cancelDrag() {
    if (!m_dragStart) return;
    m_dragStart.reset();
    if (m_latestIsPreview && !m_kept.empty()) m_kept.pop_back();
    m_latestIsPreview = false;
    m_services.store().cancel();
}

std::optional<ImageRegion> RefineController::region() const {
    return m_pending ? m_pending : m_services.store().session().refine->region;
}

void RefineController::prioritize(const ImageRegion& region, const QString& text) {
    if (!m_services.isEditable()) return;
    m_services.store().commit();
    look(region, text);
}

void RefineController::look(const ImageRegion& region, const QString& text) {
    m_pending = region;
    const double longer = std::max({m_viewSize.width(), m_viewSize.height(), 1});
    const auto pixels = [&](int side) { return std::max(1, static_cast<int>(side * kLookSize / longer + 0.5)); };
    std::array<int, 2> size{pixels(m_viewSize.width()), pixels(m_viewSize.height())};
    const RefineSettings& known = *m_services.store().session().refine;
    if (known.region == region && known.regionSize[0] > 0) size = known.regionSize; // drawn in that picture
    PictureInput picture = plainPictureInput(m_services.scene(), size[0], size[1]);
    m_look.start({std::move(picture), region, text}, tr("the region"));
    Q_EMIT busyChanged();
}

void RefineController::refineForRegion(const Look& look) {
    SessionStore& store = m_services.store();
    if (!m_services.isEditable() || !store.scene().histogram) return;
    store.commit();
    m_services.attempt(tr("Refinement failed"), [&] {
        RefineOptions by = refineOptions(store.session());
        by.priority.region = *colorsOf(look.region);
        const TransferFunction start = startOfPriority();
        apply(refineFrom(start, start, store.scene(), by), look.text, [&](RefineSettings& s) {
            s.favourNothing();
            s.region = look.region;
            s.regionSize = {look.picture.settings.width, look.picture.settings.height};
        });
        Q_EMIT refined();
    });
}

void RefineController::prioritizeNothing() {
    if (!m_services.isEditable()) return;
    m_look.cancel();
    editPart(m_services.store(), &Session::refine, tr("Clear the priority"), {},
             [](RefineSettings& r) { r.favourNothing(); });
    Q_EMIT refined();
}

void RefineController::setSelecting(Selecting what) {
    if (what == m_selecting) return;
    m_selecting = what;
    if (what == Selecting::Rectangle)
        Q_EMIT m_services.message(tr("Drag a rectangle over what should stand out; Esc cancels"));
    if (what == Selecting::Lasso) Q_EMIT m_services.message(tr("Draw round what should stand out; Esc cancels"));
    Q_EMIT selectingChanged();
}

void RefineController::setGhostShown(bool shown) {
    if (shown == m_ghost) return;
    m_ghost = shown;
    Q_EMIT ghostChanged();
}

// Live: after every edit that refinement may answer differently, as part of it.
QString RefineController::follow(const Scene& before, const Scene& after, Session& session) {
    const RefineSettings& settings = *after.session.refine;
    if (m_quiet || !settings.live || after.session.holdTargets || !m_services.isEditable() || !after.histogram ||
        before.data != after.data)
        return {};
    // An optimization has found what it was asked for.
    if (m_optimizing.isAnswering() || before.session.frame != after.session.frame) return {};
    const auto was = before.session.tf(), is = after.session.tf();
    if (was == nullptr || is == nullptr) return {};
    const bool edited = refinesOtherwise(*was, *is, settings.region || settings.hue);
    if (!edited && before.session.refine == after.session.refine &&
        before.session.measure->profile == after.session.measure->profile)
        return {};
    try {
        const auto priority = priorityOf(after);
        if (!priority) {
            later(this, [this] { refine(); });
            return {};
        }
        RefineOptions by = refineOptions(after.session);
        by.priority = *priority;
        const auto held = edited ? heldPoints(before.tf, after.tf) : std::vector<std::size_t>();
        Refinement r = refineFrom(after.tf, liveStart(*after.histogram, before.tf, after.tf, held, by), after, by);
        if (r.after == r.before) return {};
        session.setTf(r.after);
        keep(std::move(r));
        return tr("refined live");
    } catch (const Error& error) {
        say(tr("Not refined: %1").arg(QString::fromUtf8(error.what())));
        return {};
    }
}

} // namespace pellucid::gui
