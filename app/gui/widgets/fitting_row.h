// A row of controls that may have less room than all of them need.
#pragma once

#include <vector>

#include <QLayout>

namespace pellucid::gui {

/// Controls beside each other. Where the row is too narrow those of the highest rank are left out; the others keep
/// their sizes. Widgets that are hidden need no room. The row itself asks for no width.
class FittingRow : public QLayout {
public:
    explicit FittingRow(int spacing) { setSpacing(spacing); }
    ~FittingRow() override;

    /// `rank` 0: the last one to be left out.
    void add(QWidget* widget, int rank = 0);
    /// What follows stands at the right end.
    void addGap() { m_gap = m_cells.size(); }
    static bool isLeftOut(const QWidget& widget);

    void addItem(QLayoutItem* item) override;
    int count() const override { return static_cast<int>(m_cells.size()); }
    QLayoutItem* itemAt(int index) const override;
    QLayoutItem* takeAt(int index) override;
    QSize sizeHint() const override;
    QSize minimumSize() const override { return {0, sizeHint().height()}; }
    void setGeometry(const QRect& rect) override;

private:
    struct Cell {
        QLayoutItem* item;
        int rank = 0;
    };
    std::vector<const Cell*> fitting(int width) const;

    std::vector<Cell> m_cells; // owns the items
    std::size_t m_gap = 0;     // before this one
};

} // namespace pellucid::gui
