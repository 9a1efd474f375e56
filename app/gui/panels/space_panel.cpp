#include "panels/space_panel.h"

#include <algorithm>
#include <cmath>

#include <QDir>
#include <QSignalBlocker>

#include "base/atomic_file.h"
#include "dialogs/ask_file.h"
#include "image_io/image_file.h"
#include "panels/panel.h"
#include "services/services.h"
#include "session/coarser_input.h"
#include "store/edits.h"
#include "tf/shown_tf.h"
#include "widgets/layouts.h"
#include "widgets/terms.h"

namespace pellucid::gui {
namespace {

constexpr int kNone = -1;        ///< in place of a feature: no axis
constexpr int kSavedSide = 1024; ///< of a saved picture, pixels

/// Shapes and colours alone: all peaks at 1, and nothing has a name.
TransferFunction shapesOf(const TransferFunction& tf) {
    TransferFunction shapes = withFullPeaks(tf);
    for (ControlPoint& p : shapes.points) p.opacity = std::round(p.opacity * 1e9) / 1e9; // scaling has rounded
    for (Feature& f : shapes.features) {
        f.name.clear();
        f.color = {};
    }
    return shapes;
}

} // namespace

PanelInfo spacePanel() {
    return {.id = "space",
            .title = QObject::tr("Parameter space"),
            .group = PanelGroup::Shares,
            .visible = false,
            .tabOf = "features",
            .keys = QKeySequence("Ctrl+Shift+P"),
            .tip =
                QObject::tr("Attention and the distance from the targets over the opacities of two or three features"),
            .make = [](Services& services, Controllers&, QWidget* parent) {
                services.actions().addGestures(
                    {{QObject::tr("Parameter space"), QObject::tr("drag, wheel"), QObject::tr("turn, zoom")},
                     {QObject::tr("Parameter space"), QObject::tr("click"),
                      QObject::tr("set the opacities of this place of a heat map, or of this state of a path")}});
                return new SpacePanel(services, parent);
            }};
}

ParameterSpace SpacePanel::sampled(const Task& task, const JobControl& job) {
    Workspace workspace; // one of its own: figures and bars do not wait for it
    const MeasureInput input = coarserInput(task.measured, task.factor);
    const WeightFields& weights = workspace.weights(input, {job.stop, {}});
    const EngineVws function(workspace.engine(input), input.view, input.tf, weights, input.settings.vws);
    return sampleParameterSpace(function, task.targets, task.axes, job);
}

bool SpacePanel::written(const Saving& task, const JobControl& job) {
    if (task.path.ends_with(".csv"))
        writeTextAtomically(task.path, csvOf(*task.space, task.view.names));
    else
        writeImage(spaceImage(*task.space, task.view, job), task.path);
    return true;
}

void SpacePanel::takeSpace(const Task& task, ParameterSpace& space) {
    m_space = std::make_shared<const ParameterSpace>(std::move(space));
    m_targets = task.targets;
    m_inputs = task.inputs;
    m_computedFeatures = task.features;
    m_usedFactor = task.factor;
    refresh();
}

SpacePanel::SpacePanel(Services& services, QWidget* parent)
    : QWidget(parent), m_services(services),
      m_job(sampled, [this](const Task& task, ParameterSpace& space) { takeSpace(task, space); }),
      m_saving(written, [this](const Saving& task, bool&) { m_services.saySaved(QString::fromStdString(task.path)); }) {
    setObjectName("spacePanel");
    const char* const axisNames[] = {"X", "Y", "Z"};
    for (std::size_t a = 0; a < 3; ++a) {
        named(m_features[a], QStringLiteral("spaceAxis%1").arg(axisNames[a]),
              tr("The feature whose opacity, 0 to 1, is the %1 axis; the features without an axis keep their "
                 "opacities.\nWithout a third one: a heat map")
                  .arg(QString(axisNames[a]).toLower()));
        connect(m_features[a], &QComboBox::activated, this, [this, a] { chooseAxes(a); });
    }
    m_samples->setRange(2, kMostAxisSamples);
    m_samples->setValue(ParameterAxes{}.samples);
    m_scale->addItems({tr("linear"), tr("logarithmic")});
    m_factor->addItem(tr("automatic"), 0);
    m_factor->addItem(tr("full volume"), 1);
    m_factor->addItem(tr("halved"), 2);
    m_factor->addItem(tr("a quarter"), 4);
    m_reading->setMinimumHeight(2 * fontMetrics().lineSpacing()); // so that nothing moves below the mouse
    m_reading->setAlignment(Qt::AlignLeft | Qt::AlignTop);

    auto* form = narrowForm(new QFormLayout);
    form->addRow(tr("x axis"), m_features[0]);
    form->addRow(tr("y axis"), m_features[1]);
    form->addRow(tr("z axis"), m_features[2]);
    form->addRow(tr("Samples"), rowOf({m_samples, {m_scale, 1}}));
    form->addRow(tr("Volume"), m_factor);
    form->addRow(tr("Show"), m_shown);
    auto* computing = rowOf({{m_compute, 1}, m_cancel, {m_progress, 1}});
    setLayout(inset(columnOf({form, computing, rowOf({{m_least, 1}, m_save}), m_words, {m_canvas, 1}, m_reading}),
                    {8, 8, 8, 8}));

    connect(m_compute, &QPushButton::clicked, this, &SpacePanel::compute);
    connect(m_cancel, &QPushButton::clicked, this, &SpacePanel::cancel);
    connect(m_least, &QPushButton::clicked, this, [this] {
        if (isCurrent())
            apply(m_space->opacitiesAt(m_space->positionOfSample(m_space->best)), tr("Nearest to the targets"));
    });
    connect(m_save, &QToolButton::clicked, this, &SpacePanel::save);
    connect(m_samples, &QSpinBox::valueChanged, this, &SpacePanel::refresh);
    for (QComboBox* box : {m_scale, m_factor, m_shown})
        connect(box, &QComboBox::currentIndexChanged, this, &SpacePanel::refresh);
    connect(m_canvas, &SpaceCanvas::read, m_reading, &QLabel::setText);
    connect(m_canvas, &SpaceCanvas::picked, this,
            [this](const std::vector<double>& x) { apply(x, tr("Opacities from the parameter space")); });
    connect(&m_job, &JobBase::progress, this,
            [this](double fraction) { m_progress->setValue(static_cast<int>(1000 * fraction)); });
    connect(&m_job, &JobBase::busyChanged, this, &SpacePanel::refresh);
    connect(&m_job, &JobBase::failed, this,
            [this](const Error& error) { m_services.showError(tr("The parameter space cannot be computed"), error); });
    connect(&m_saving, &JobBase::busyChanged, this, &SpacePanel::refresh);
    connect(&m_saving, &JobBase::failed, this,
            [this](const Error& error) { m_services.showError(tr("The parameter space cannot be saved"), error); });
    connect(&services.store(), &SessionStore::changed, this, &SpacePanel::follow);
    connect(&services, &Services::readOnlyChanged, this, &SpacePanel::refresh);
    fillFeatures();
}

void SpacePanel::showEvent(QShowEvent* event) {
    QWidget::showEvent(event);
    refresh(); // while hidden it has followed nothing
}

ParameterAxes SpacePanel::axes() const {
    ParameterAxes axes;
    for (const QComboBox* box : m_features)
        if (box->currentIndex() >= 0 && box->currentData().toInt() != kNone)
            axes.features.push_back(static_cast<std::size_t>(box->currentData().toInt()));
    axes.samples = m_samples->value();
    axes.scale = m_scale->currentIndex() == 0 ? AxisScale::Linear : AxisScale::Logarithmic;
    return axes;
}

SpacePanel::Inputs SpacePanel::inputs() const {
    Inputs inputs{measureInput(m_services.scene()), {}, axes(), m_factor->currentData().toInt()};
    inputs.others = featureOpacities(inputs.measured.tf);
    for (const std::size_t f : inputs.axes.features) inputs.others[f] = 0;
    inputs.measured.tf = shapesOf(inputs.measured.tf);
    return inputs;
}

bool SpacePanel::isCurrent() const {
    return m_space != nullptr && m_services.store().hasVolume() && axes().features.size() >= 2 && inputs() == m_inputs;
}

bool SpacePanel::isPictureComplete() const { return m_canvas->isComplete(); }

void SpacePanel::follow(const Scene& before, const Scene& after) {
    if (before.volume != after.volume) {
        m_job.cancel();
        m_space.reset();
    }
    if (before.tf.features != after.tf.features || before.volume != after.volume) fillFeatures();
    if (isVisible()) refresh();
}

void SpacePanel::fillFeatures() {
    const Scene& scene = m_services.scene();
    const TransferFunction wanted = scene.wantedTf(); // what is empty changes nothing, whatever its opacity
    std::vector<int> shown;
    for (std::size_t f = 0; f < wanted.features.size(); ++f)
        if (!wanted.features[f].hidden) shown.push_back(static_cast<int>(f));
    // As they were chosen, where those are still there; else those of the largest targets.
    std::vector<int> chosen;
    for (const std::size_t f : axes().features) chosen.push_back(static_cast<int>(f));
    const bool kept = chosen.size() >= 2 && std::all_of(chosen.begin(), chosen.end(), [&](int f) {
                          return std::find(shown.begin(), shown.end(), f) != shown.end();
                      });
    if (!kept) {
        chosen.clear();
        if (m_services.store().hasVolume() && shown.size() >= 2)
            for (const std::size_t f : defaultAxes(wanted, m_services.scene().targets()))
                chosen.push_back(static_cast<int>(f));
    }
    for (std::size_t a = 0; a < 3; ++a) {
        const QSignalBlocker quiet(m_features[a]);
        m_features[a]->clear();
        if (a == 2) m_features[a]->addItem(tr("none"), kNone);
        for (const int f : shown)
            m_features[a]->addItem(QString::fromStdString(scene.tf.features[static_cast<std::size_t>(f)].name), f);
        m_features[a]->setCurrentIndex(m_features[a]->findData(a < chosen.size() ? chosen[a] : kNone));
    }
    keepChosen();
    const QSignalBlocker quiet(m_shown);
    const int before = m_shown->count() > 0 ? m_shown->currentData().toInt() : kObjective;
    m_shown->clear();
    m_shown->addItem(tr("Distance from the targets"), kObjective);
    for (const int f : shown)
        m_shown->addItem(
            tr("Attention on %1").arg(QString::fromStdString(scene.tf.features[static_cast<std::size_t>(f)].name)), f);
    m_shown->setCurrentIndex(std::max(0, m_shown->findData(before)));
}

/// The axis that had a feature which another one was given takes the feature of that one.
void SpacePanel::chooseAxes(std::size_t changed) {
    const int feature = m_features[changed]->currentData().toInt();
    const auto isFree = [this](int f) {
        return f != kNone && std::none_of(m_features.begin(), m_features.end(),
                                          [f](const QComboBox* box) { return box->currentData().toInt() == f; });
    };
    for (std::size_t a = 0; a < 3; ++a) {
        if (a == changed || feature == kNone || m_chosen[a] != feature) continue;
        int other = m_chosen[changed];
        for (int i = 0; other == kNone && i < m_features[a]->count(); ++i) // x and y always have one
            if (isFree(m_features[a]->itemData(i).toInt())) other = m_features[a]->itemData(i).toInt();
        QComboBox* const box = other == kNone ? m_features[changed] : m_features[a];
        box->setCurrentIndex(box->findData(other));
    }
    keepChosen();
    refresh();
}

void SpacePanel::keepChosen() {
    for (std::size_t a = 0; a < 3; ++a)
        m_chosen[a] = m_features[a]->currentIndex() < 0 ? kNone : m_features[a]->currentData().toInt();
}

void SpacePanel::compute() {
    if (!m_services.store().hasVolume() || m_job.isRunning() || axes().features.size() < 2) return;
    const std::vector<Feature>& features = m_services.scene().tf.features;
    if (std::all_of(features.begin(), features.end(), [](const Feature& f) { return f.hidden; })) return;
    const Inputs now = inputs();
    Task task{measureInput(m_services.scene()), m_services.scene().targets(), now.axes, now.factor, now,
              m_services.scene().tf.features};
    if (task.measured.settings.profile == Profile::Published)
        task.factor = 1; // it knows planes of voxels, and no lengths
    else if (task.factor == 0)
        task.factor = reductionFor(task.measured.volume->size(), task.axes);
    m_progress->setValue(0);
    m_job.start(std::move(task), tr("the parameter space"));
}

SpaceView SpacePanel::view() const {
    SpaceView view;
    const bool current = isCurrent();
    for (const Feature& f : current ? m_services.scene().tf.features : m_computedFeatures) {
        view.names.push_back(f.name);
        view.colors.push_back(f.color);
    }
    view.shown = m_shown->currentData().toInt();
    if (view.shown >= static_cast<int>(view.names.size())) view.shown = kObjective;
    view.tolerance = m_services.scene().session.optimize->tolerance;
    if (!current) return view;
    view.paths = pathsOfRuns(*m_services.scene().session.runs, m_services.scene().tf, m_space->axes);
    view.present = featureOpacities(shownTf(m_services.scene().tf));
    return view;
}

void SpacePanel::refresh() {
    const bool hasTwo = m_services.store().hasVolume() && axes().features.size() >= 2;
    const bool current = isCurrent(), running = m_job.isRunning(), mayEdit = current && !m_services.isReadOnly();
    if (current) // F follows from W
        if (std::vector<double> wanted = m_services.scene().targets(); wanted != m_targets && isAimed(wanted)) {
            m_space = std::make_shared<const ParameterSpace>(withTargets(*m_space, wanted));
            m_targets = std::move(wanted);
        }
    m_compute->setEnabled(hasTwo && !running && !current);
    m_cancel->setVisible(running);
    m_progress->setVisible(running);
    m_least->setVisible(!running);
    m_least->setEnabled(mayEdit);
    m_save->setVisible(!running);
    m_save->setEnabled(current && !m_saving.isRunning());
    m_canvas->setPickable(mayEdit);
    m_words->setText(words(hasTwo, running, current));
    m_canvas->setOutdated(
        m_space != nullptr && !current ? tr("Of an earlier state or other settings.\nCompute it again.") : QString());
    m_canvas->setSpace(m_space, m_space == nullptr ? SpaceView{} : view());
}

QString SpacePanel::words(bool hasTwo, bool running, bool current) const {
    const ParameterAxes chosen = axes();
    if (running) return tr("Sampling %L1 combinations of opacities…").arg(chosen.sampleCount());
    if (!hasTwo)
        return m_services.store().hasVolume() ? tr("A parameter space needs two features that are shown.") : QString();
    if (!current)
        return tr("%L1 combinations of opacities, in %L2 sweeps over the volume.")
            .arg(chosen.sampleCount())
            .arg(chosen.sweepCount());
    const auto x = m_space->opacitiesAt(m_space->positionOfSample(m_space->best));
    QStringList places;
    for (const std::size_t f : m_space->axes.features)
        places << QStringLiteral("%1 %2").arg(QString::fromStdString(m_services.scene().tf.features[f].name),
                                              QString::number(x[f], 'g', 3));
    QString text = tr("Nearest to the targets of %L1 samples: %2, at %3.")
                       .arg(m_space->evaluations)
                       .arg(terms().offTarget(m_space->objective[m_space->best]), places.join(", "));
    if (m_usedFactor > 1) text += tr(" Of a copy of the volume that is coarser by %1.").arg(m_usedFactor);
    return text;
}

void SpacePanel::apply(const std::vector<double>& opacities, const QString& text) {
    if (!isCurrent() || m_services.isReadOnly()) return;
    SessionStore& store = m_services.store();
    store.commit();
    editTf(store, withShownOpacities(m_services.scene().tf, opacities), text);
    Q_EMIT m_services.message(text + ".");
}

void SpacePanel::save() {
    const QString folder = keptFolder("imageFolder", QDir::homePath());
    const QString path =
        QFileDialog::getSaveFileName(this, tr("Save parameter space"), QDir(folder).filePath("parameter-space.png"),
                                     tr("Pictures (*.png *.tif *.exr *.jpg);;Tables (*.csv)"));
    if (path.isEmpty()) return;
    keepFolderOf("imageFolder", path);
    saveTo(path);
}

void SpacePanel::saveTo(const QString& path) {
    if (!isCurrent()) return;
    SpaceView as = view();
    as.width = as.height = kSavedSide;
    as.camera = m_canvas->shownView().camera;
    m_saving.start({m_space, std::move(as), path.toStdString()}, path);
}

} // namespace pellucid::gui
