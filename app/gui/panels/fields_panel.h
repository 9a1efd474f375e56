// The panel of fields: which one is drawn in the place of the data, how, and where it is saved.
#pragma once

#include <functional>

#include <QWidget>

class QComboBox;
class QDoubleSpinBox;
class QLabel;
class QLineEdit;
class QProgressBar;
class QPushButton;
class QSlider;

namespace pellucid {
struct FieldView;
}

namespace pellucid::gui {

class FieldController;
class Services;

class FieldsPanel : public QWidget {
    Q_OBJECT
public:
    FieldsPanel(Services& services, FieldController& fields, QWidget* parent = nullptr);

    QSize sizeHint() const override; ///< without scrolling

private:
    using Change = std::function<void(FieldView&)>;
    void edit(const QString& text, const QString& mergeKey, const Change& change);
    /// From a slider that may be held: a preview until it is let go.
    void slide(const QSlider& slider, const QString& text, const Change& change);
    void editTop();
    void follow();      ///< the session
    void followField(); ///< what has become of the field

    Services& m_services;
    FieldController& m_fields;
    QComboBox *m_kind, *m_feature, *m_colorMap;
    QSlider *m_strengthSlider, *m_thresholdSlider;
    QDoubleSpinBox *m_strength, *m_threshold; ///< opacity; per cent of the top
    QLineEdit* m_top;
    QPushButton *m_usualTop, *m_stop, *m_save;
    QLabel* m_state;
    QProgressBar* m_progress;
    bool m_showing = false; ///< the controls show, they do not edit
};

} // namespace pellucid::gui
