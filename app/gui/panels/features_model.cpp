#include "panels/features_model.h"

#include "store/edits.h"
#include "tf/edit.h"
#include "tf/shapes.h"
#include "widgets/number_text.h"
#include "widgets/theme.h"

namespace pellucid::gui {

FeaturesModel::FeaturesModel(SessionStore& store, Results& results, QObject* parent)
    : QAbstractTableModel(parent), m_store(store), m_results(results) {
    connect(&store, &SessionStore::changed, this, &FeaturesModel::follow);
    connect(&results, &Results::changed, this, [this] { refresh(Visibility, Vws); });
    follow({}, store.scene());
}

void FeaturesModel::follow(const Scene& before, const Scene& after) {
    const int rows = static_cast<int>(after.tf.features.size());
    if (rows != m_rows) {
        beginResetModel();
        m_rows = rows;
        m_opacities = featureOpacities(after.tf);
        endResetModel();
        return;
    }
    if (before.volume == after.volume && before.tf == after.tf && before.session.goals.isSame(after.session.goals) &&
        before.onlyFeature() == after.onlyFeature())
        return;
    m_opacities = featureOpacities(after.tf);
    refresh(Eye, Target);
}

void FeaturesModel::refresh(Column first, Column last) {
    if (m_rows > 0) Q_EMIT dataChanged(index(0, first), index(m_rows - 1, last));
}

int FeaturesModel::rowCount(const QModelIndex& parent) const { return parent.isValid() ? 0 : m_rows; }
int FeaturesModel::columnCount(const QModelIndex& parent) const { return parent.isValid() ? 0 : ColumnCount; }

QVariant FeaturesModel::data(const QModelIndex& index, int role) const {
    if (!checkIndex(index, CheckIndexOption::IndexIsValid)) return {};
    const auto f = static_cast<std::size_t>(index.row());
    const Scene& scene = m_store.scene();
    // Between a change of the scene and its signal the rows are those of before.
    if (f >= scene.tf.features.size() || f >= m_opacities.size()) return {};
    const Feature& feature = scene.tf.features[f];
    const Measures* const measures = m_results.measures();
    const bool measured = measures && f < measures->features.size();

    if (role == LockRole) {
        const OpacityLimits limits = opacityLimits(m_store, index.row());
        return static_cast<int>(limits.locked                             ? Lock::Locked
                                : limits.lowest > 0 || limits.highest < 1 ? Lock::Limited
                                                                          : Lock::None);
    }
    if (role == Qt::TextAlignmentRole && index.column() > Range) return QVariant(Qt::AlignRight | Qt::AlignVCenter);
    if (role == Qt::ForegroundRole && !isDrawn(index.row())) return theme::kFaint;
    if (role == Qt::DecorationRole && index.column() == Name) return colorFromRgb(feature.color);
    if (role == Qt::ToolTipRole) {
        const QString text = headerData(index.column(), Qt::Horizontal, Qt::ToolTipRole).toString();
        if (scene.isEmpty(f)) return text + "\n" + emptyFeatureText(scene, index.row());
        const OpacityLimits limits = opacityLimits(m_store, index.row());
        if (limits.locked) return text + tr("\nLocked: Optimize leaves its opacity as it is");
        if (limits.lowest > 0 || limits.highest < 1)
            return text + tr("\nOptimize keeps its opacity between %1 and %2").arg(limits.lowest).arg(limits.highest);
        return text;
    }
    if (role != Qt::DisplayRole && role != Qt::EditRole) return {};

    double number = 0;
    switch (index.column()) {
    case Eye:
        return role == Qt::EditRole ? QVariant(!feature.hidden) : QVariant();
    case Name:
        return role == Qt::DisplayRole && scene.isEmpty(f) ? tr("%1 (empty)").arg(QString::fromStdString(feature.name))
                                                           : QString::fromStdString(feature.name);
    case Range: {
        if (!m_store.hasVolume()) return {};
        const Volume& volume = *scene.volume;
        const double span = volume.range().hi - volume.range().lo;
        return QStringLiteral("%1 – %2").arg(numberText(volume.valueOfIntensity(feature.a), span),
                                             numberText(volume.valueOfIntensity(feature.b), span));
    }
    case Opacity:
        number = m_opacities[f];
        break;
    case Visibility:
        if (!measured) return {};
        number = measures->features[f].visibility;
        break;
    case Vws:
        if (!measured) return {};
        number = measures->features[f].vws;
        break;
    case Target:
        if ((feature.hidden || scene.isEmpty(f)) && role == Qt::DisplayRole) return QStringLiteral("–");
        number = scene.targets().at(f);
        break;
    default:
        return {};
    }
    if (role == Qt::EditRole) return number;
    return QString::number(number, 'f', index.column() == Opacity && number < 0.1 ? 4 : 3);
}

QVariant FeaturesModel::headerData(int section, Qt::Orientation orientation, int role) const {
    if (orientation != Qt::Horizontal || section < 0 || section >= ColumnCount)
        return QAbstractTableModel::headerData(section, orientation, role);
    if (role == Qt::DisplayRole) {
        static const std::array<const char*, ColumnCount> names{"",
                                                                QT_TR_NOOP("Feature"),
                                                                QT_TR_NOOP("Values"),
                                                                QT_TR_NOOP("Opacity"),
                                                                QT_TR_NOOP("Visibility"),
                                                                QT_TR_NOOP("VWS"),
                                                                QT_TR_NOOP("Target")};
        const char* const text = names[static_cast<std::size_t>(section)];
        return *text == 0 ? QString() : tr(text);
    }
    if (role == Qt::ToolTipRole) {
        switch (section) {
        case Eye:
            return tr("Show or hide the feature; hidden, it is neither drawn nor measured, and has no target.\n"
                      "Alt+click or Ctrl+click: draw only this one, or all again");
        case Name:
            return tr("Name and colour of the feature; click the colour to change it, double-click the name");
        case Range:
            return tr("Values of the feature's voxels, in the units of the data");
        case Opacity:
            return tr("Highest opacity of the feature: opacity of a path one voxel long (d0)");
        case Visibility:
            return tr("Share of the picture that the feature makes, 0 to 1, from this camera");
        case Vws:
            return tr("Visibility-weighted saliency: share of what catches the eye that the feature has, 0 to 1");
        case Target:
            return tr("The share of saliency that Optimize aims at; all targets add up to 1");
        default:
            break;
        }
    }
    return {};
}

Qt::ItemFlags FeaturesModel::flags(const QModelIndex& index) const {
    Qt::ItemFlags flags = QAbstractTableModel::flags(index);
    if (!index.isValid() || m_readOnly) return flags;
    if (index.column() == Target &&
        m_store.scene().wantedTf().features.at(static_cast<std::size_t>(index.row())).hidden)
        return flags;
    if (index.column() == Eye || index.column() == Name || index.column() == Opacity || index.column() == Target)
        flags |= Qt::ItemIsEditable;
    return flags;
}

bool FeaturesModel::setData(const QModelIndex& index, const QVariant& value, int role) {
    if (m_readOnly || !checkIndex(index, CheckIndexOption::IndexIsValid)) return false;
    if (index.column() == Name && role == Qt::DecorationRole) {
        const auto color = value.value<QColor>();
        if (!color.isValid()) return false;
        m_store.commit();
        editTf(m_store, withFeatureColor(m_store.scene().tf, index.row(), rgbFromColor(color)),
               tr("Colour of feature"));
        return true;
    }
    if (role != Qt::EditRole) return false;
    if (index.column() == Eye) {
        const bool shown = value.toBool();
        m_store.commit();
        editTf(m_store, withFeatureHidden(m_store.scene().tf, index.row(), !shown),
               shown ? tr("Show feature") : tr("Hide feature"));
        return true;
    }
    if (index.column() == Name) {
        const QString name = value.toString().trimmed();
        if (name.isEmpty()) return false;
        m_store.commit();
        editTf(m_store, withFeatureName(m_store.scene().tf, index.row(), name.toStdString()), tr("Rename feature"));
        return true;
    }
    bool isNumber = false;
    const double number = value.toDouble(&isNumber);
    if (!isNumber || !(number >= 0 && number <= 1)) return false;
    if (!flags(index).testFlag(Qt::ItemIsEditable)) return false;
    if (index.column() == Target) {
        editTarget(m_store, index.row(), number, tr("Target of feature"), QStringLiteral("target-%1").arg(index.row()));
        return true;
    }
    if (index.column() != Opacity) return false;
    previewOpacity(index.row(), number);
    m_store.commit(QStringLiteral("opacity-%1").arg(index.row()));
    return true;
}

void FeaturesModel::previewOpacity(int row, double opacity) {
    // From the shape before the preview every time: a shape that has been scaled to 0 is lost.
    try {
        previewTf(m_store, withFeatureOpacity(m_store.committed().tf, row, opacity), tr("Opacity of feature"));
    } catch (const Error&) {
        m_store.cancel(); // the feature has no point that could be raised
    }
}

void FeaturesModel::endPreview() { m_store.commit(); }

bool FeaturesModel::isDrawn(int row) const {
    const Scene& scene = m_store.scene();
    const auto f = static_cast<std::size_t>(row);
    if (f >= scene.tf.features.size() || scene.tf.features[f].hidden) return false;
    const int only = scene.onlyFeature();
    return only < 0 || only == row;
}

void FeaturesModel::setReadOnly(bool on) {
    m_readOnly = on;
    refresh(Eye, Target);
}

} // namespace pellucid::gui
