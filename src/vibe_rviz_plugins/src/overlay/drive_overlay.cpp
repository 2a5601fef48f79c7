#include "overlay/drive_overlay.hpp"

#include <QFontMetrics>
#include <QPainter>
#include <QPainterPath>
#include <algorithm>
#include <cmath>

#include "vibe_operator/messages/button_bank.hpp"
#include "vibe_operator/messages/number_text.hpp"
#include "vibe_operator/messages/reference_values.hpp"

namespace vibe::rviz_plugins {
namespace {

constexpr double kPanelWidth = 196, kStateWidth = 186, kPlateMargin = 8, kRow = 18, kCapSize = 15,
                 kGap = 5;                      // [pixels at scale 1]
constexpr double kText = 11, kBannerText = 14;  // heights of fonts
constexpr double kCapColumn = 68;               // where the texts of the keys begin
constexpr double kMillimetresOfMercury = 133.322;
constexpr double kHighForce = 8;  // "almost 8 N at most" in the reference of kPullingForce [N]

const QColor kPlate(14, 18, 24, 178), kInk(236, 240, 244), kFaint(150, 162, 174), kCap(52, 62, 74);
const QColor kLit(255, 196, 64), kLitInk(40, 26, 0), kTrack(60, 70, 82), kBarFill(96, 176, 232),
    kTrouble(120, 44, 30, 215);
const QColor kGood(86, 196, 108), kWarning(240, 196, 64), kBad(232, 78, 62);

QString toQt(const std::string& text) {
  return QString::fromStdString(text);
}

/// Paints in units of scale 1 on a plate with round corners.
class Plate {
 public:
  Plate(double width, double height, double scale, const QColor& colour)
      : image_(pixels(width, scale), pixels(height, scale), QImage::Format_ARGB32) {
    image_.fill(Qt::transparent);
    painter_.begin(&image_);
    painter_.setRenderHints(QPainter::Antialiasing | QPainter::TextAntialiasing);
    painter_.scale(scale, scale);
    QPainterPath outline;
    outline.addRoundedRect(QRectF(0, 0, width, height), 7, 7);
    painter_.fillPath(outline, colour);
    setFont(kText, false);
  }
  Plate(const Plate&) = delete;
  Plate& operator=(const Plate&) = delete;

  void setFont(double height, bool bold) {
    QFont font = painter_.font();
    font.setPixelSize(static_cast<int>(height));
    font.setBold(bold);
    painter_.setFont(font);
  }
  void text(const QRectF& place, int alignment, const QString& words, const QColor& colour) {
    painter_.setPen(colour);
    painter_.drawText(place, alignment, words);
  }
  void box(const QRectF& place, double radius, const QColor& colour) {
    painter_.setPen(Qt::NoPen);
    painter_.setBrush(colour);
    painter_.drawRoundedRect(place, radius, radius);
  }
  double widthOf(const QString& words) const { return painter_.fontMetrics().horizontalAdvance(words); }
  QImage finish() {
    painter_.end();
    return image_;
  }

 private:
  QImage image_;
  QPainter painter_;

  static int pixels(double length, double scale) { return std::max(1, static_cast<int>(std::lround(length * scale))); }
};

bool isDown(const DriveHud& hud, int key) {
  if (key == Qt::Key_Z && hud.keys_down.count(Qt::Key_Y) > 0) return true;
  return key != 0 && hud.keys_down.count(key) > 0;
}

/// Keys that have chosen something stay lit.
bool isChosen(const DriveHud& hud, int key) {
  const operating::KeyBinding* binding = operating::findBinding(key);
  if (binding == nullptr) return false;
  if (binding->kind == operating::KeyBinding::Kind::Gear) return static_cast<int>(hud.gear) == binding->index;
  return binding->kind == operating::KeyBinding::Kind::Button && hud.buttons[static_cast<std::size_t>(binding->index)];
}

void drawKeyRow(const DriveHud& hud, const operating::KeyRow& row, double y, Plate& plate) {
  double x = kPlateMargin;
  for (const operating::KeyRow::Cap& cap : row.caps) {
    const bool lit = isDown(hud, cap.key) || isChosen(hud, cap.key);
    const QString label = toQt(cap.label);
    const double width = std::max(kCapSize - 1, plate.widthOf(label) + 6);
    plate.box({x, y + 1.5, width, kCapSize}, 3, lit ? kLit : kCap);
    plate.text({x, y + 1.5, width, kCapSize}, Qt::AlignCenter, label, lit ? kLitInk : kInk);
    x += width + 1.5;
  }
  const double left = kCapColumn + kPlateMargin;
  plate.text({left, y, kPanelWidth - left, kRow}, Qt::AlignVCenter, toQt(row.text), kInk);
}

struct JointRow {
  const char* name;
  double unit;  // of what is shown [m] or [rad]
  const char* suffix;
};
constexpr double kDegree = 0.017453292519943295, kTurn = 6.283185307179586;
constexpr std::array<JointRow, operating::kJointCount> kJointRows = {{{"Insertion", 1e-3, " mm"},
                                                                      {"Rotation", kDegree, "°"},
                                                                      {"Up, down", kDegree, "°"},
                                                                      {"Left, right", kDegree, "°"},
                                                                      {"Helix out", 1e-3, " mm"},
                                                                      {"Helix turns", kTurn, ""},
                                                                      {"Arm closed", 1e-3, " mm"}}};

constexpr double kNameWidth = 68, kBarLeft = kPlateMargin + kNameWidth, kBarWidth = 34;

void drawRow(const QString& name, const QString& value, double y, Plate& plate) {
  plate.text({kPlateMargin, y, kNameWidth, kRow}, Qt::AlignVCenter, name, kFaint);
  plate.text({kBarLeft + kBarWidth, y, kStateWidth - kPlateMargin - kBarLeft - kBarWidth, kRow},
             Qt::AlignVCenter | Qt::AlignRight, value, kInk);
}

/// A bar from one share of its length to another.
void drawBar(double from, double to, double y, const QColor& colour, Plate& plate) {
  const double left = std::clamp(std::min(from, to), 0.0, 1.0), right = std::clamp(std::max(from, to), 0.0, 1.0);
  plate.box({kBarLeft, y + 7, kBarWidth, 4}, 2, kTrack);
  plate.box({kBarLeft + left * kBarWidth, y + 6, std::max(2.0, (right - left) * kBarWidth), 6}, 2, colour);
}

/// The bar of a joint begins at 0 if 0 is inside of its range, so that both directions can be told apart.
void drawJoint(const DriveHud& hud, std::size_t joint, double y, Plate& plate) {
  const operating::JointLimit& limit = hud.limits[joint];
  const JointRow& row = kJointRows[joint];
  const double range = limit.upper - limit.lower;
  const auto share = [&](double value) { return range > 0 ? (value - limit.lower) / range : 0; };
  const int decimals =
      static_cast<int>(joint) == operating::HelixRotation || static_cast<int>(joint) == operating::NeedleDriver ? 1 : 0;
  const std::string number = operating::numberText(hud.joints[joint] / row.unit, decimals);
  drawRow(row.name, toQt(number) + (number == operating::kNoValue ? "" : row.suffix), y, plate);
  const double zero = std::clamp(0.0, limit.lower, limit.upper);
  const bool known = std::isfinite(hud.joints[joint]);
  drawBar(share(zero), share(known ? hud.joints[joint] : zero), y, known ? kBarFill : kTrack, plate);
}

QColor colourOfForce(double force) {
  return force > kHighForce ? kBad : force > operating::kPullingForce.high ? kWarning : kGood;
}

void drawForce(double force, double y, Plate& plate) {
  const bool known = std::isfinite(force);
  drawRow("Force", known ? toQt(operating::quantityText(force, 1, "N")) : "-", y, plate);
  drawBar(0, known ? force / operating::kPullingForce.bar_end : 0, y, known ? colourOfForce(force) : kTrack, plate);
}

void drawPressure(double pressure, double y, Plate& plate) {
  constexpr double kBarEnd = 25;  // as in the panel [mmHg]
  const double value = pressure / kMillimetresOfMercury;
  drawRow("Gas", std::isfinite(value) ? toQt(operating::quantityText(value, 1, "mmHg")) : "-", y, plate);
  if (std::isfinite(value)) drawBar(0, value / kBarEnd, y, kBarFill, plate);
}

void drawWords(const QString& name, const std::string& words, double y, Plate& plate) {
  plate.text({kPlateMargin, y, kNameWidth, kRow}, Qt::AlignVCenter, name, kFaint);
  plate.text({kBarLeft, y, kStateWidth - kPlateMargin - kBarLeft, kRow}, Qt::AlignVCenter | Qt::AlignRight, toQt(words),
             kInk);
}

void drawButtons(const DriveHud& hud, double y, Plate& plate) {
  const std::array<const char*, 6> names = {"APC", "Grab", "Needle", "T-tag", "Cinch", "Gas"};
  const double width = (kStateWidth - 2 * kPlateMargin) / 3;
  for (std::size_t i = 0; i < names.size(); ++i) {
    const double row = static_cast<double>(i / 3), column = static_cast<double>(i % 3);
    const QRectF place(kPlateMargin + width * column, y + row * kRow + 1, width - 2, kRow - 3);
    plate.box(place, 3, hud.buttons[i] ? kLit : kCap);
    plate.text(place, Qt::AlignCenter, names[i], hud.buttons[i] ? kLitInk : kFaint);
  }
}

}  // namespace

QImage drawnKeys(const DriveHud& hud, double scale) {
  const auto& rows = operating::keyRows();
  const auto gaps =
      std::count_if(rows.begin(), rows.end(), [](const operating::KeyRow& row) { return row.ends_group; });
  const double height = kRow * static_cast<double>(rows.size()) + kGap * static_cast<double>(gaps);
  Plate plate(kPanelWidth, 2 * kPlateMargin - 4 + height, scale, kPlate);
  double y = kPlateMargin - 2;
  for (const operating::KeyRow& row : rows) {
    drawKeyRow(hud, row, y, plate);
    y += row.ends_group ? kRow + kGap : kRow;
  }
  return plate.finish();
}

QImage drawnState(const DriveHud& hud, double scale) {
  constexpr double kRows = operating::kJointCount + 7;  // two bars, three texts, two rows of buttons
  Plate plate(kStateWidth, 2 * (kPlateMargin + kGap) - 2 + kRow * kRows, scale, kPlate);
  double y = kPlateMargin - 2;
  for (std::size_t joint = 0; joint < hud.joints.size(); ++joint, y += kRow) drawJoint(hud, joint, y, plate);
  y += kGap;
  drawForce(hud.force, y, plate);
  drawPressure(hud.pressure, y + kRow, plate);
  drawWords("Tissue", hud.tissue, y + 2 * kRow, plate);
  drawWords("Needle", hud.needle, y + 3 * kRow, plate);
  drawWords("Bites", hud.bites, y + 4 * kRow, plate);
  drawButtons(hud, y + 5 * kRow + kGap, plate);
  return plate.finish();
}

QImage drawnBanner(const DriveHud& hud, double scale, int width) {
  const bool trouble = !hud.trouble.empty();
  const QString number = trouble ? "!" : QString::number(hud.step.number);
  const QString words = toQt(trouble ? hud.trouble : hud.step.text);
  QFont font;
  font.setPixelSize(static_cast<int>(kBannerText));
  const double badge = 22, most = width / scale - 3 * kPlateMargin - badge;
  const QRectF text = QFontMetricsF(font).boundingRect(QRectF(0, 0, most, 200), Qt::TextWordWrap, words);
  const double height = std::max(badge, text.height()) + kPlateMargin;
  Plate plate(std::ceil(text.width()) + 3 * kPlateMargin + badge, height, scale, trouble ? kTrouble : kPlate);
  const QRectF place(kPlateMargin, (height - badge) / 2, badge, badge);
  plate.box(place, badge / 2, trouble ? kBad : kLit);
  plate.setFont(kBannerText, true);
  plate.text(place, Qt::AlignCenter, number, trouble ? kInk : kLitInk);
  plate.setFont(kBannerText, false);
  plate.text({2 * kPlateMargin + badge, 0, text.width() + 2, height}, Qt::AlignVCenter | Qt::TextWordWrap, words, kInk);
  return plate.finish();
}

double overlayScale(int width, int height) {
  return std::clamp(std::min(width / 640.0, height / 480.0), 0.8, 1.4);
}

bool sitBeside(const QImage& keys, const QImage& state, int width) {
  constexpr int kGaps = 48;  // to the edges and between the panels [pixels]
  return keys.width() + state.width() + kGaps <= width;
}

}  // namespace vibe::rviz_plugins
