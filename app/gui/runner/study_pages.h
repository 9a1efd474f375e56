// The pages of a study's window: texts with buttons, the task, the picture, the question.
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include <QImage>
#include <QLabel>
#include <QPushButton>
#include <QWidget>

class QBoxLayout;
class QScrollArea;

namespace pellucid::gui {

/// The colours of a study's background and of what is written on it.
QPalette studyPalette(const QColor& background);

/// A title and a text in the middle, scrolled where it is long, with buttons below.
class TextPage : public QWidget {
    Q_OBJECT
public:
    TextPage(const QString& id, const QString& title, QWidget* parent);

    void setTitle(const QString& title) { m_title->setText(title); }
    void setText(const QString& text) { m_text->setText(text); }
    QString text() const { return m_text->text(); }
    /// In a row. The first one is pressed by Return.
    QPushButton* addButton(const QString& id, const QString& text, const std::function<void()>& press);
    void stackButtons(); ///< those that it has

protected:
    void showEvent(QShowEvent* event) override;
    void resizeEvent(QResizeEvent* event) override;

private:
    void fitText(); ///< no more room than it needs

    QLabel *m_title, *m_text;
    QScrollArea* m_area;
    QBoxLayout* m_buttons;
    QPushButton* m_first = nullptr;
};

/// A page that tells when it can be seen.
class SeenPage : public QWidget {
    Q_OBJECT
public:
    using QWidget::QWidget;

Q_SIGNALS:
    void painted();

protected:
    void paintEvent(QPaintEvent* event) override;
    virtual void paint(QPainter&) {}
};

/// A question in large letters.
class TaskPage : public SeenPage {
public:
    using SeenPage::SeenPage;
    void setText(const QString& text);
    const QString& text() const { return m_text; }

protected:
    void paint(QPainter& painter) override;

private:
    QString m_text;
};

/// A picture in its own pixels in the middle, smaller where the screen is.
class PicturePage : public SeenPage {
public:
    using SeenPage::SeenPage;
    void setImage(const QImage& image);

protected:
    void paint(QPainter& painter) override;

private:
    QImage m_image;
};

/// Scores as buttons with their labels, and one to leave the answer out. Keys are heard by the window.
class QuestionPage : public SeenPage {
    Q_OBJECT
public:
    QuestionPage(const std::map<int, std::string>& labels, QWidget* parent);
    void setText(const QString& text) { m_text->setText(text); }

Q_SIGNALS:
    void scored(int score);
    void skipped();

private:
    QLabel* m_text;
};

} // namespace pellucid::gui
