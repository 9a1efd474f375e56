// The features as a table: eye, colour and name, range, opacity, visibility, VWS, target, 2D feature saliency.
#pragma once

#include <QAbstractTableModel>

#include <vector>

#include "services/results.h"
#include "store/session_store.h"

namespace pellucid::gui {

class PictureSaliencyController;

/// One row per feature of the scene's transfer function. Eye, name, opacity and target can be edited; each is an undo
/// step.
class FeaturesModel : public QAbstractTableModel {
    Q_OBJECT
public:
    enum Column { Eye, Name, Range, Opacity, Visibility, Vws, Target, PictureShare, ColumnCount };
    enum class Lock { None, Limited, Locked };    ///< what an optimization may do to the opacity
    static constexpr int LockRole = Qt::UserRole; ///< a Lock, of any column

    FeaturesModel(SessionStore& store, Results& results, QObject* parent = nullptr);
    /// Has shares of the picture from now on; `saliency` outlives this.
    void setPictureSaliency(const PictureSaliencyController& saliency);

    int rowCount(const QModelIndex& parent = {}) const override;
    int columnCount(const QModelIndex& parent = {}) const override;
    /// EditRole gives numbers in [0,1] for Opacity, Visibility, Vws, Target and PictureShare, and whether the eye is
    /// open; DecorationRole of Name the colour.
    QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
    QVariant headerData(int section, Qt::Orientation orientation, int role = Qt::DisplayRole) const override;
    Qt::ItemFlags flags(const QModelIndex& index) const override;
    bool setData(const QModelIndex& index, const QVariant& value, int role = Qt::EditRole) override;

    /// While a slider is held: shows the opacity without an undo step. setData() or endPreview() end it.
    void previewOpacity(int row, double opacity);
    void endPreview();
    void setReadOnly(bool on);
    bool isReadOnly() const { return m_readOnly; }
    /// Whether the picture shows the feature: its eye is open, and no other one is drawn alone.
    bool isDrawn(int row) const;

private:
    void follow(const Scene& before, const Scene& after);
    void refresh(Column first, Column last);
    QVariant text(std::size_t feature, int column, int role) const;      ///< of Eye, Name and Range
    std::optional<double> number(std::size_t feature, int column) const; ///< of the others; empty: not measured
    QString tip(int row, int column) const;

    SessionStore& m_store;
    Results& m_results;
    const PictureSaliencyController* m_saliency = nullptr;
    int m_rows = 0;
    std::vector<double> m_opacities;
    bool m_readOnly = false;
};

} // namespace pellucid::gui
