#include "runner/study_pages.h"

#include <cmath>

#include <QPainter>
#include <QScrollArea>

#include "study/study.h"
#include "widgets/layouts.h"
#include "widgets/named.h"
#include "widgets/theme.h"

namespace pellucid::gui {
namespace {

constexpr int kStackWidth = 420;                                    // of buttons below each other
constexpr int kTextWidth = 760;                                     // logical pixels, of lines that are read with ease
constexpr double kTitleSize = 2, kTaskSize = 2.4, kTextSize = 1.35; // of the usual letters

QFont scaled(const QFont& font, double factor) {
    QFont larger = font;
    larger.setPointSizeF(font.pointSizeF() * factor);
    return larger;
}

QLabel* centredLabel(double size, QWidget* parent) {
    auto* label = new QLabel(parent);
    label->setFont(scaled(parent->font(), size));
    label->setTextFormat(Qt::PlainText);
    label->setWordWrap(true);
    label->setAlignment(Qt::AlignHCenter | Qt::AlignVCenter);
    return label;
}

QPushButton* largeButton(const QString& id, const QString& text, QWidget* parent) {
    auto* button = named(new QPushButton(text, parent), id);
    button->setFont(scaled(parent->font(), kTextSize));
    button->setMinimumSize(button->sizeHint().width() + 36, 44);
    button->setAutoDefault(true);
    return button;
}

} // namespace

QPalette studyPalette(const QColor& background) {
    const bool onWhite = contrast(background, Qt::black) > contrast(background, Qt::white);
    const QColor ink = onWhite ? Qt::black : Qt::white,
                 button = between(background, onWhite ? Qt::white : Qt::black, 0.35);
    QPalette palette;
    for (const auto role : {QPalette::Window, QPalette::Base}) palette.setColor(role, background);
    for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText}) {
        palette.setColor(role, ink);
        palette.setColor(QPalette::Disabled, role, between(ink, background, 0.5));
    }
    palette.setColor(QPalette::Button, button);
    palette.setColor(QPalette::Light, between(button, Qt::white, 0.2));
    palette.setColor(QPalette::Dark, between(button, Qt::black, 0.3));
    palette.setColor(QPalette::Mid, between(button, Qt::black, 0.15));
    palette.setColor(QPalette::Highlight, ink);
    palette.setColor(QPalette::HighlightedText, background);
    return palette;
}

TextPage::TextPage(const QString& id, const QString& title, QWidget* parent)
    : QWidget(parent), m_title(named(centredLabel(kTitleSize, this), "studyTitle")),
      m_text(named(centredLabel(kTextSize, this), "studyText")), m_area(new QScrollArea(this)),
      m_buttons(rowOf({Cell::rest(), Cell::rest()}, 24)) {
    setObjectName(id);
    m_title->setText(title);
    m_text->setMaximumWidth(kTextWidth);
    m_text->setAlignment(Qt::AlignLeft | Qt::AlignTop);
    auto* inner = new QWidget(this);
    inner->setLayout(inset(rowOf({Cell::rest(), {m_text, 1000}, Cell::rest()}), {}));
    m_area->setWidget(inner);
    m_area->setWidgetResizable(true);
    m_area->setFrameShape(QFrame::NoFrame);
    setLayout(
        inset(columnOf({Cell::rest(), m_title, Cell::gap(24), {m_area, 100}, Cell::gap(32), m_buttons, Cell::rest()}),
              {40, 40, 40, 40}));
}

QPushButton* TextPage::addButton(const QString& id, const QString& text, const std::function<void()>& press) {
    auto* button = largeButton(id, text, this);
    if (m_first == nullptr) m_first = button;
    m_buttons->insertWidget(m_buttons->count() - 1, button, 0, Qt::AlignHCenter);
    connect(button, &QPushButton::clicked, this, press);
    return button;
}

void TextPage::stackButtons() {
    m_buttons->setDirection(QBoxLayout::TopToBottom);
    for (QPushButton* button : findChildren<QPushButton*>()) button->setMinimumWidth(kStackWidth);
}

void TextPage::showEvent(QShowEvent* event) {
    QWidget::showEvent(event);
    fitText();
    if (m_first != nullptr) m_first->setFocus();
}

void TextPage::resizeEvent(QResizeEvent* event) {
    QWidget::resizeEvent(event);
    fitText();
}

void TextPage::fitText() {
    const int room = std::min(kTextWidth, m_area->viewport()->width());
    m_area->setMaximumHeight(m_text->heightForWidth(room) + 4);
}

void SeenPage::paintEvent(QPaintEvent*) {
    QPainter painter(this);
    painter.fillRect(rect(), palette().window());
    paint(painter);
    painter.end();
    Q_EMIT painted();
}

void TaskPage::setText(const QString& text) {
    m_text = text;
    update();
}

void TaskPage::paint(QPainter& painter) {
    painter.setPen(palette().windowText().color());
    painter.setFont(scaled(font(), kTaskSize));
    painter.drawText(rect().adjusted(60, 60, -60, -60), Qt::AlignCenter | Qt::TextWordWrap, m_text);
}

void PicturePage::setImage(const QImage& image) {
    m_image = image;
    update();
}

void PicturePage::paint(QPainter& painter) {
    if (m_image.isNull()) return;
    const double density = devicePixelRatioF();
    QSizeF size = QSizeF(m_image.size()) / density; // a pixel of the picture is one of the screen
    if (size.width() > width() || size.height() > height()) {
        size.scale(QSizeF(this->size()), Qt::KeepAspectRatio);
        painter.setRenderHint(QPainter::SmoothPixmapTransform);
    }
    const auto edge = [density](double room) { return std::round(room / 2 * density) / density; };
    painter.drawImage(QRectF(QPointF(edge(width() - size.width()), edge(height() - size.height())), size), m_image);
}

QuestionPage::QuestionPage(const std::map<int, std::string>& labels, QWidget* parent)
    : SeenPage(parent), m_text(named(centredLabel(kTitleSize, this), "studyQuestion")) {
    auto* scores = rowOf({Cell::rest()}, 18);
    for (int score = kLowestScore; score <= kHighestScore; ++score) {
        auto* button = largeButton(QStringLiteral("score%1").arg(score), QString::number(score), this);
        button->setFont(scaled(font(), kTitleSize));
        button->setFixedSize(110, 72);
        button->setFocusPolicy(Qt::NoFocus); // keys are scores
        connect(button, &QPushButton::clicked, this, [this, score] { Q_EMIT scored(score); });
        auto* label = centredLabel(kTextSize, this);
        label->setAlignment(Qt::AlignHCenter | Qt::AlignTop);
        label->setFixedWidth(130);
        if (const auto at = labels.find(score); at != labels.end()) label->setText(QString::fromStdString(at->second));
        scores->addLayout(columnOf({rowOf({Cell::rest(), button, Cell::rest()}), label}, 6));
    }
    scores->addStretch(1);
    auto* hint = centredLabel(kTextSize, this);
    hint->setText(tr("Press a key from 1 to 5, or click."));
    auto* skip = largeButton("scoreSkip", tr("Leave it out (0)"), this);
    skip->setFocusPolicy(Qt::NoFocus);
    connect(skip, &QPushButton::clicked, this, &QuestionPage::skipped);
    setLayout(inset(columnOf({Cell::rest(), m_text, Cell::gap(40), scores, Cell::gap(10), hint, Cell::gap(40),
                              rowOf({Cell::rest(), skip, Cell::rest()}), Cell::rest()}),
                    {40, 40, 40, 40}));
}

} // namespace pellucid::gui
