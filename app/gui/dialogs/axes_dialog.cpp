#include "dialogs/axes_dialog.h"

#include <algorithm>

#include <QCheckBox>
#include <QComboBox>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>

#include "dialogs/closing_buttons.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"

namespace pellucid::gui {
namespace {

constexpr std::array<int, 6> kDirections{1, -1, 2, -2, 3, -3}; // as GridAxes has them

QString directionText(int along, bool patient) {
    constexpr std::array<const char*, 6> kPatient{QT_TR_NOOP("left"),  QT_TR_NOOP("right"), QT_TR_NOOP("back"),
                                                  QT_TR_NOOP("front"), QT_TR_NOOP("head"),  QT_TR_NOOP("feet")};
    constexpr std::array<const char*, 6> kWorld{"+x", "−x", "+y", "−y", "+z", "−z"};
    const auto at =
        static_cast<std::size_t>(std::find(kDirections.begin(), kDirections.end(), along) - kDirections.begin());
    return patient ? QObject::tr(kPatient.at(at)) : QString::fromUtf8(kWorld.at(at));
}

} // namespace

AxesDialog::AxesDialog(const GridAxes& now, const Int3& dims, QWidget* parent) : QDialog(parent) {
    setObjectName("axesDialog");
    setWindowTitle(tr("Orientation"));
    auto* what = wrappedLabel("axesWhat", this);
    what->setText(tr("Say where each axis of the file points, from its first voxel to its last. This replaces what the "
                     "file says, and is kept in the session."));
    m_patient = named(new QCheckBox(tr("The data are of a &patient"), this), "axesPatient",
                      tr("Left and right are the patient's own. Views, letters and coordinates then use the words of "
                         "anatomy."));
    m_patient->setChecked(now.patient);
    auto* form = inset(new QFormLayout(this), {18, 16, 18, 12});
    form->setVerticalSpacing(9);
    form->addRow(what);
    form->addRow(m_patient);
    for (int a = 0; a < 3; ++a) {
        auto* combo = named(new QComboBox(this), QStringLiteral("axesAlong") + QChar("ijk"[a]),
                            tr("Which way this axis of the data runs in the world, or in the patient"));
        m_along[static_cast<std::size_t>(a)] = combo;
        form->addRow(tr("Axis %1, %L2 voxels, points to").arg(QChar("ijk"[a])).arg(dims[a]), combo);
        connect(combo, &QComboBox::currentIndexChanged, this, &AxesDialog::check);
    }
    m_verdict = wrappedLabel("axesVerdict", this);
    auto* buttons = closingButtons(*this, QDialogButtonBox::Ok | QDialogButtonBox::Cancel);
    m_ok = buttons->button(QDialogButtonBox::Ok);
    form->addRow(m_verdict);
    form->addRow(buttons);
    connect(m_patient, &QCheckBox::toggled, this, [this] { fill(axes()); });
    fill(now);
}

GridAxes AxesDialog::axes() const {
    GridAxes axes;
    for (std::size_t a = 0; a < 3; ++a) axes.along[a] = m_along[a]->currentData().toInt();
    axes.patient = m_patient->isChecked();
    return axes;
}

void AxesDialog::fill(const GridAxes& axes) {
    for (std::size_t a = 0; a < 3; ++a) {
        const QSignalBlocker blocker(m_along[a]);
        m_along[a]->clear();
        for (const int along : kDirections) m_along[a]->addItem(directionText(along, m_patient->isChecked()), along);
        m_along[a]->setCurrentIndex(m_along[a]->findData(axes.along[a]));
    }
    check();
}

void AxesDialog::check() {
    const GridAxes chosen = axes();
    const bool fits = isComplete(chosen);
    m_ok->setEnabled(fits);
    m_verdict->setText(!fits ? tr("Two axes lie along one line. Give each axis a direction of its own.")
                       : isMirrored(chosen)
                           ? tr("Axes that run like this show the data as in a mirror, unless the file was written so.")
                           : QString());
}

} // namespace pellucid::gui
