#include "panels/features_model.h"

#include "controllers/picture_saliency_controller.h"
#include "store/edits.h"
#include "tf/edit.h"
#include "tf/shapes.h"
#include "widgets/number_text.h"
#include "widgets/terms.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

/// By FeaturesModel::Column: name and tool tip.
const std::array<std::pair<const char*, const char*>, FeaturesModel::ColumnCount> kHeaders{
    std::pair{"", QT_TR_NOOP("Show or hide the feature; hidden, it is neither drawn nor measured, and has no target.\n"
                             "Alt+click or Ctrl+click: draw only this one, or all again")},
    {QT_TR_NOOP("Feature"),
     QT_TR_NOOP("Name and colour of the feature; click the colour to change it, double-click the name")},
    {QT_TR_NOOP("Values"), QT_TR_NOOP("Values of the feature's voxels, in the unit of the data")},
    {QT_TR_NOOP("Opacity"), QT_TR_NOOP("Highest opacity of the feature: opacity of a path one voxel long (d0)")},
    {"", QT_TR_NOOP("How much of the picture the feature makes up from this camera, 0 to 1.\n"
                    "Visibility: what its voxels show of themselves, divided by what all voxels show")},
    {"", QT_TR_NOOP("How much of what catches the eye belongs to the feature, 0 to 1.\n"
                    "Visibility-weighted saliency, VWS: the sum of visibility × saliency over its voxels, divided\n"
                    "by that over all voxels")},
    {QT_TR_NOOP("Target"), QT_TR_NOOP("The share of attention that Optimize aims at; all targets add up to 1")},
    {"", QT_TR_NOOP("How much of what catches the eye in the picture on the screen belongs to the feature, 0 to 1.\n"
                    "2D feature saliency, 2DFS: the feature's part of the picture's saliency map")}};

/// What a column is called.
QString titleOf(int column) {
    switch (column) {
    case FeaturesModel::Visibility:
        return terms().visibility();
    case FeaturesModel::Vws:
        return terms().attention();
    case FeaturesModel::PictureShare:
        return terms().pictureSaliency();
    default:
        const char* const title = kHeaders.at(static_cast<std::size_t>(column)).first;
        return *title == 0 ? QString() : FeaturesModel::tr(title);
    }
}

bool isLimited(const OpacityLimits& limits) { return limits.lowest > 0 || limits.highest < 1; }

} // namespace

FeaturesModel::FeaturesModel(SessionStore& store, Results& results, QObject* parent)
    : QAbstractTableModel(parent), m_store(store), m_results(results) {
    connect(&store, &SessionStore::changed, this, &FeaturesModel::follow);
    connect(&results, &Results::changed, this, [this] { refresh(Visibility, Vws); });
    connect(&terms(), &Terms::changed, this, [this] { Q_EMIT headerDataChanged(Qt::Horizontal, 0, ColumnCount - 1); });
    follow({}, store.scene());
}

void FeaturesModel::setPictureSaliency(const PictureSaliencyController& saliency) {
    m_saliency = &saliency;
    connect(&saliency, &PictureSaliencyController::changed, this, [this] { refresh(PictureShare, PictureShare); });
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
    refresh(Eye, PictureShare);
}

void FeaturesModel::refresh(Column first, Column last) {
    if (m_rows > 0) Q_EMIT dataChanged(index(0, first), index(m_rows - 1, last));
}

int FeaturesModel::rowCount(const QModelIndex& parent) const { return parent.isValid() ? 0 : m_rows; }
int FeaturesModel::columnCount(const QModelIndex& parent) const { return parent.isValid() ? 0 : ColumnCount; }

QVariant FeaturesModel::data(const QModelIndex& index, int role) const {
    if (!checkIndex(index, CheckIndexOption::IndexIsValid)) return {};
    const auto f = static_cast<std::size_t>(index.row());
    const int column = index.column();
    const Scene& scene = m_store.scene();
    // Between a change of the scene and its signal the rows are those of before.
    if (f >= scene.tf.features.size() || f >= m_opacities.size()) return {};
    switch (role) {
    case LockRole: {
        const OpacityLimits limits = opacityLimits(m_store, index.row());
        return static_cast<int>(limits.locked ? Lock::Locked : isLimited(limits) ? Lock::Limited : Lock::None);
    }
    case Qt::TextAlignmentRole:
        return column > Range ? QVariant(Qt::AlignRight | Qt::AlignVCenter) : QVariant();
    case Qt::ForegroundRole:
        return isDrawn(index.row()) ? QVariant() : QVariant(theme::kFaint);
    case Qt::DecorationRole:
        return column == Name ? QVariant(colorFromRgb(scene.tf.features[f].color)) : QVariant();
    case Qt::ToolTipRole:
        return tip(index.row(), column);
    case Qt::DisplayRole:
    case Qt::EditRole:
        break;
    default:
        return {};
    }
    if (column <= Range) return text(f, column, role);
    if (column == Target && role == Qt::DisplayRole && (scene.tf.features[f].hidden || scene.isEmpty(f)))
        return QStringLiteral("–");
    const std::optional<double> number = this->number(f, column);
    if (!number) return {};
    if (role == Qt::EditRole) return *number;
    return QString::number(*number, 'f', column == Opacity && *number < 0.1 ? 4 : 3);
}

QVariant FeaturesModel::text(std::size_t f, int column, int role) const {
    const Scene& scene = m_store.scene();
    const Feature& feature = scene.tf.features[f];
    if (column == Eye) return role == Qt::EditRole ? QVariant(!feature.hidden) : QVariant();
    if (column == Name) {
        const QString name = QString::fromStdString(feature.name);
        return role == Qt::DisplayRole && scene.isEmpty(f) ? tr("%1 (empty)").arg(name) : name;
    }
    if (!m_store.hasVolume()) return {};
    const Volume& volume = *scene.volume;
    const double span = volume.range().hi - volume.range().lo;
    return QStringLiteral("%1 – %2").arg(numberText(volume.valueOfIntensity(feature.a), span),
                                         numberText(volume.valueOfIntensity(feature.b), span));
}

std::optional<double> FeaturesModel::number(std::size_t f, int column) const {
    if (column == Opacity) return m_opacities[f];
    if (column == Target) return m_store.scene().targets().at(f);
    if (column == PictureShare) return m_saliency ? m_saliency->share(f) : std::nullopt;
    const Measures* const measures = m_results.measures();
    if (!measures || f >= measures->features.size()) return {};
    return column == Visibility ? measures->features[f].visibility : measures->features[f].vws;
}

QString FeaturesModel::tip(int row, int column) const {
    const QString text = headerData(column, Qt::Horizontal, Qt::ToolTipRole).toString();
    const Scene& scene = m_store.scene();
    if (scene.isEmpty(static_cast<std::size_t>(row))) return text + "\n" + emptyFeatureText(scene, row);
    const OpacityLimits limits = opacityLimits(m_store, row);
    if (limits.locked) return text + tr("\nLocked: Optimize leaves its opacity as it is");
    if (isLimited(limits))
        return text + tr("\nOptimize keeps its opacity between %1 and %2").arg(limits.lowest).arg(limits.highest);
    return text;
}

QVariant FeaturesModel::headerData(int section, Qt::Orientation orientation, int role) const {
    const bool known = role == Qt::DisplayRole || role == Qt::ToolTipRole;
    if (orientation != Qt::Horizontal || section < 0 || section >= ColumnCount || !known)
        return QAbstractTableModel::headerData(section, orientation, role);
    return role == Qt::DisplayRole ? titleOf(section) : tr(kHeaders[static_cast<std::size_t>(section)].second);
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
    refresh(Eye, PictureShare);
}

} // namespace pellucid::gui
