#include "dialogs/spacing_dialog.h"

#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QLabel>

#include "dialogs/closing_buttons.h"
#include "volume/spacing.h"
#include "widgets/controls.h"
#include "widgets/layouts.h"

namespace pellucid::gui {
namespace {

/// A length without zeros behind its last digit.
class LengthBox : public QDoubleSpinBox {
public:
    explicit LengthBox(QWidget* parent) : QDoubleSpinBox(parent) {
        setDecimals(12);
        setRange(kLeastSpacing, kMostSpacing);
        setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
    }
    QString textFromValue(double length) const override {
        QString text = locale().toString(length, 'f', decimals()).remove(locale().groupSeparator());
        while (text.endsWith(locale().zeroDigit())) text.chop(1);
        if (text.endsWith(locale().decimalPoint())) text.chop(1);
        return text;
    }
};

} // namespace

SpacingFields::SpacingFields(QWidget* parent, const QString& noUnit) : QObject(parent) {
    for (std::size_t a = 0; a < 3; ++a) {
        const QChar axis = "xyz"[a];
        QDoubleSpinBox* box =
            named<QDoubleSpinBox>(new LengthBox(parent), QStringLiteral("spacing") + axis.toUpper(),
                                  tr("Distance from one voxel to the next along axis %1 of the data").arg(axis));
        box->setAccessibleName(tr("Spacing along %1").arg(axis));
        box->setPrefix(QStringLiteral("%1  ").arg(axis));
        m_distances[a] = box;
    }
    m_unit = named(new QComboBox(parent), "spacingUnit", tr("The unit of these distances, for scale bar and measures"));
    m_unit->setAccessibleName(tr("Unit of length"));
    m_unit->addItem(noUnit, static_cast<int>(LengthUnit::Unknown));
    for (int unit = static_cast<int>(LengthUnit::Femtometre); unit <= static_cast<int>(LengthUnit::Foot); ++unit)
        m_unit->addItem(QString::fromUtf8(sign(static_cast<LengthUnit>(unit))), unit);
    setValue({});
}

void SpacingFields::addTo(QFormLayout& form) {
    form.addRow(tr("Spacing"), rowOf({m_distances[0], m_distances[1], m_distances[2]}));
    form.addRow(tr("Unit of length"), m_unit);
}

void SpacingFields::setValue(const GridSpacing& spacing) {
    for (std::size_t a = 0; a < 3; ++a) m_distances[a]->setValue(spacing.distances[static_cast<int>(a)]);
    m_unit->setCurrentIndex(m_unit->findData(static_cast<int>(spacing.unit)));
    m_given = spacing;
}

GridSpacing SpacingFields::value() const {
    GridSpacing spacing = m_given;
    for (std::size_t a = 0; a < 3; ++a) {
        double& distance = spacing.distances[static_cast<int>(a)];
        const QDoubleSpinBox& box = *m_distances[a];
        if (box.textFromValue(distance) != box.textFromValue(box.value())) distance = box.value();
    }
    spacing.unit = static_cast<LengthUnit>(m_unit->currentData().toInt());
    return spacing;
}

SpacingDialog::SpacingDialog(const GridSpacing& now, QWidget* parent) : QDialog(parent) {
    setObjectName("spacingDialog");
    setWindowTitle(tr("Voxel spacing"));
    QLabel* what = wrappedLabel("spacingWhat", this);
    what->setText(tr("Enter the distances between voxels. They replace what the file states, and are saved with the "
                     "session. The shape of the volume, its scale bar and all measures follow."));
    auto* form = inset(new QFormLayout(this), {18, 16, 18, 12});
    form->setVerticalSpacing(9);
    form->addRow(what);
    m_fields = new SpacingFields(this, tr("as in the file"));
    m_fields->addTo(*form);
    m_fields->setValue(now);
    form->addRow(closingButtons(*this, QDialogButtonBox::Ok | QDialogButtonBox::Cancel));
}

} // namespace pellucid::gui
