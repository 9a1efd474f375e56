// The panel of fields: which one is drawn in the place of the data, how, and where it is saved.
#pragma once

#include <functional>

#include <QWidget>

class QComboBox;
class QLabel;
class QLineEdit;
class QProgressBar;
class QPushButton;

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
    void editTop();
    void follow();      ///< the session
    void followField(); ///< what has become of the field

    Services& m_services;
    FieldController& m_fields;
    QComboBox *m_kind, *m_feature, *m_colorMap;
    QLineEdit* m_top;
    QPushButton *m_usualTop, *m_stop, *m_save;
    QLabel* m_state;
    QProgressBar* m_progress;
};

} // namespace pellucid::gui
