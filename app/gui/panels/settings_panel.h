// How figures are computed and how optimizations search.
#pragma once

#include <QWidget>

class QFormLayout;

namespace pellucid::gui {

class Services;

/// All settings that figures and optimizations depend on, each an edit of the session.
class SettingsPanel : public QWidget {
    Q_OBJECT
public:
    explicit SettingsPanel(Services& services, QWidget* parent = nullptr);

private:
    void addOptimization(QFormLayout& form);
    void addMeasuring(QFormLayout& form);

    Services& m_services;
};

} // namespace pellucid::gui
