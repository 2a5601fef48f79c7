#pragma once
#include <algorithm>
#include <array>
#include <string>
#include <vector>

#include "procedure/suturing.hpp"
#include "vibe_core/procedure/procedure_registry.hpp"
#include "vibe_core/suture/technique.hpp"
#include "vibe_testing/worlds.hpp"

namespace vibe::test {

constexpr double kSpacing = 4e-3, kSheetHeight = 4e-3;
constexpr int kColumns = 21, kRows = 13;  // odd, so that a row and a column lie in the middle

inline int sheetParticle(int column, int row) {
  return row * kColumns + column;
}

inline bool onBorder(int column, int row) {
  return row == 0 || column == 0 || row == kRows - 1 || column == kColumns - 1;
}

/// Both triangles of a square; diagonals are mirrored at both middles, those of the underside lie under the others.
inline void addSquare(int column, int row, bool under, SurfaceMesh& mesh) {
  const int a = sheetParticle(column, row) + (under ? kColumns * kRows : 0), b = a + 1, d = a + kColumns, e = d + 1;
  const bool rising = (column < kColumns / 2) == (row < kRows / 2);
  const std::array<int, 3> first = rising ? std::array<int, 3>{a, b, e} : std::array<int, 3>{a, b, d};
  const std::array<int, 3> second = rising ? std::array<int, 3>{a, e, d} : std::array<int, 3>{b, e, d};
  for (const auto& t : {first, second}) mesh.triangles.push_back(under ? std::array<int, 3>{t[0], t[2], t[1]} : t);
}

/// The side below two neighbours on the border, which follow each other counter-clockwise.
inline void addSide(int from, int to, SurfaceMesh& mesh) {
  const int below = kColumns * kRows;
  mesh.triangles.push_back({from, from + below, to + below});
  mesh.triangles.push_back({from, to + below, to});
}

/// A flat box around the origin, whose upper side is the sheet. All but the inner part of the sheet carries the mark of
/// an end, so that a scene can hold it.
inline Organ sheet() {
  SurfaceMesh mesh;
  for (const double height : {kSheetHeight, -kSheetHeight})
    for (int r = 0; r < kRows; ++r)
      for (int c = 0; c < kColumns; ++c)
        mesh.vertices.emplace_back(kSpacing * (c - kColumns / 2), kSpacing * (r - kRows / 2), height);
  for (const bool under : {false, true})
    for (int r = 0; r + 1 < kRows; ++r)
      for (int c = 0; c + 1 < kColumns; ++c) addSquare(c, r, under, mesh);
  for (int c = 0; c + 1 < kColumns; ++c) {
    addSide(sheetParticle(c, 0), sheetParticle(c + 1, 0), mesh);
    addSide(sheetParticle(c + 1, kRows - 1), sheetParticle(c, kRows - 1), mesh);
  }
  for (int r = 0; r + 1 < kRows; ++r) {
    addSide(sheetParticle(kColumns - 1, r), sheetParticle(kColumns - 1, r + 1), mesh);
    addSide(sheetParticle(0, r + 1), sheetParticle(0, r), mesh);
  }
  Organ organ = plainOrgan(std::move(mesh), 2.3e-3);
  for (int r = 0; r < kRows; ++r)
    for (int c = 0; c < kColumns; ++c) {
      if (onBorder(c, r)) organ.end[sheetParticle(c, r)] = End::Oesophagus;
      organ.end[sheetParticle(c, r) + kColumns * kRows] = End::Oesophagus;
    }
  return organ;
}

inline Scene sheetScene(const std::string& model, const std::string& pulling) {
  Scene scene = bareScene();
  scene.tissue.model = model;
  scene.tissue.substeps = 0;
  scene.tissue.mass_damping = 20;
  scene.attach_oesophagus = true;
  scene.suture = SutureScene{};
  scene.suture->cinch_model = pulling;
  scene.suture->group_particles = 100;
  return scene;
}

/// The sheet with one set of two bites on its middle row, `reach` columns to either side of the middle.
struct PulledSheet : World {
  PulledSheet(const Scene& scene, int reach) : World(scene, sheet()) {
    Suture& set = state.procedure.sutures.emplace_back();
    for (const int column : {kColumns / 2 - reach, kColumns / 2 + reach}) {
      Bite bite;
      bite.particle = {sheetParticle(column, kRows / 2)};
      bite.weight = {1};
      bite.depth = bite.thickness = 2.3e-3;
      set.bites.push_back(bite);
    }
    set.length = {2 * reach * kSpacing};
    set.tension = {0};
    set.technique = static_cast<std::uint8_t>(Technique::Other);
    set.stage = Suture::Stage::Cinching;
    if (model->cinch) model->cinch->begin(*model, state, set);
  }

  Suture& set() { return state.procedure.sutures.front(); }
  const Suture& set() const { return state.procedure.sutures.front(); }
  Eigen::Vector3d bite(int b) const { return bitePosition(set().bites[b], state.x, state.y, state.z); }
  double apart() const { return (bite(1) - bite(0)).norm(); }

  /// Draws while the wall bears it, as the cinch does. @param way  of the farthest particle [m]
  void draw(double way, double speed = 15e-3) {
    const double part = speed * model->scene.step_period;
    for (double left = way; left > 1e-9; left -= part) {
      if (model->cinch)
        model->cinch->draw(*model, state, std::min(part, left), set());
      else
        drawThread(std::min(part, left), set());
      step();
    }
  }
};

}  // namespace vibe::test
