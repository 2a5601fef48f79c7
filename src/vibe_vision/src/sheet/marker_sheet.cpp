#include "vibe_vision/sheet/marker_sheet.hpp"

#include <cairo-pdf.h>
#include <cairo-svg.h>

#include <cmath>
#include <memory>

#include "sheet/sheet_layout.hpp"
#include "vibe_core/files/files.hpp"
#include "vibe_core/program/error.hpp"

namespace vibe::vision {
namespace {

constexpr double kPointsPerMetre = 72 / 25.4e-3;
constexpr double kMillimetresPerMetre = 1e3;

struct SurfaceDeleter {
  void operator()(cairo_surface_t* surface) const { cairo_surface_destroy(surface); }
};
using Surface = std::unique_ptr<cairo_surface_t, SurfaceDeleter>;

void requireGood(const Surface& surface, const std::string& file) {
  const cairo_status_t status = cairo_surface_status(surface.get());
  if (status == CAIRO_STATUS_SUCCESS) return;
  throw Error(file + ": cannot be written (" + cairo_status_to_string(status) +
              "); give a file in an existing folder that you may write to");
}

}  // namespace

double flatTurn(const SleeveDesign& sleeve, double paper_thickness) {
  return M_PI * (sleeve.diameter - paper_thickness);
}

double rodDiameter(const SleeveDesign& sleeve, double paper_thickness) {
  return sleeve.diameter - 2 * paper_thickness;
}

MarkerSheet::MarkerSheet(const VisionConfig& config, const SheetOptions& options)
    : options_(options), pages_(layOut(config, options)) {}

void MarkerSheet::writePdf(const std::string& file) const {
  WholeFile whole(file, "The sheet");
  const Surface surface(
      cairo_pdf_surface_create(whole.part().c_str(), width() * kPointsPerMetre, height() * kPointsPerMetre));
  requireGood(surface, file);
  for (std::size_t i = 0; i < pages_.size(); ++i)
    paintPage(surface.get(), kPointsPerMetre, options_, pages_[i], i + 1, pages_.size());
  cairo_surface_finish(surface.get());
  requireGood(surface, file);
  whole.finish(true);
}

std::vector<std::string> MarkerSheet::writeSvg(const std::string& file) const {
  const std::string end = ".svg";
  if (file.size() <= end.size() || file.compare(file.size() - end.size(), end.size(), end) != 0) {
    throw Error(file + ": does not end in .svg; give a file name that does");
  }
  const std::string stem = file.substr(0, file.size() - end.size());
  std::vector<std::string> files;
  for (std::size_t i = 0; i < pages_.size(); ++i) {
    files.push_back(pages_.size() == 1 ? file : stem + "-" + std::to_string(i + 1) + end);
    WholeFile whole(files.back(), "The sheet");
    const Surface surface(cairo_svg_surface_create(whole.part().c_str(), width() * kMillimetresPerMetre,
                                                   height() * kMillimetresPerMetre));
    requireGood(surface, files.back());
    cairo_svg_surface_set_document_unit(surface.get(), CAIRO_SVG_UNIT_MM);
    paintPage(surface.get(), kMillimetresPerMetre, options_, pages_[i], i + 1, pages_.size());
    cairo_surface_finish(surface.get());
    requireGood(surface, files.back());
    whole.finish(true);
  }
  return files;
}

SheetRaster MarkerSheet::raster(std::size_t page, double pixels_per_metre) const {
  SheetRaster raster;
  raster.width = static_cast<int>(std::lround(width() * pixels_per_metre));
  raster.height = static_cast<int>(std::lround(height() * pixels_per_metre));
  const Surface surface(cairo_image_surface_create(CAIRO_FORMAT_RGB24, raster.width, raster.height));
  requireGood(surface, "raster of the sheet");
  paintPage(surface.get(), pixels_per_metre, options_, pages_.at(page), page + 1, pages_.size());
  cairo_surface_flush(surface.get());
  const unsigned char* data = cairo_image_surface_get_data(surface.get());
  const int stride = cairo_image_surface_get_stride(surface.get());
  raster.value.reserve(static_cast<std::size_t>(raster.width) * static_cast<std::size_t>(raster.height));
  for (int y = 0; y < raster.height; ++y) {
    for (int x = 0; x < raster.width; ++x)
      raster.value.push_back(data[static_cast<std::ptrdiff_t>(y) * stride + 4 * x]);
  }
  return raster;
}

}  // namespace vibe::vision
