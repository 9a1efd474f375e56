// How figures are computed and how optimizations search.
#pragma once

#include <functional>
#include <vector>

#include <QWidget>

class QComboBox;
class QDoubleSpinBox;
class QFormLayout;

namespace pellucid {
struct MeasureSettings;
struct OptimizeOptions;
} // namespace pellucid

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
    void follow();
    void editOptions(const std::function<void(OptimizeOptions&)>& change);
    void editMeasuring(const std::function<void(MeasureSettings&)>& change);
    void chooseBackground();

    Services& m_services;
    std::vector<std::function<void()>> m_show; ///< each brings one control to the present state
    bool m_showing = false;                    ///< what controls say comes of the session
};

} // namespace pellucid::gui
