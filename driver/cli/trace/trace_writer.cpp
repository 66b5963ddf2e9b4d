// SPDX-License-Identifier: MIT
#include "cli/trace/trace_writer.hpp"

#include <cerrno>
#include <cmath>
#include <cstring>
#include <limits>

#include "base/regular_file.hpp"
#include "base/short_number.hpp"
#include "document/csv.hpp"

namespace hapticd::cli {

namespace {

constexpr const char* kHeader =
    "t,model,feature,u,v,px,py,pz,nx,ny,nz,depth,fx,fy,fz,tx,ty,tz,contact,iterations,status,"
    "mx,my,mz,mqw,mqx,mqy,mqz\n";

}  // namespace

Result<std::unique_ptr<TraceWriter>> TraceWriter::open(const std::string& file, const scene::Scene& scene,
                                                       std::vector<uint32_t> models) {
  std::FILE* out = file == "-" ? stdout : std::fopen(file.c_str(), "w");
  if (out == nullptr) return Error{file + ": cannot be written: " + std::strerror(errno)};
  std::fputs(kHeader, out);
  return std::unique_ptr<TraceWriter>(new TraceWriter(out, file, scene, std::move(models)));
}

TraceWriter::TraceWriter(std::FILE* out, std::string file, const scene::Scene& scene, std::vector<uint32_t> models)
    : out_(out), file_(std::move(file)), models_(std::move(models)) {
  for (const scene::Model& model : scene.models) names_.push_back(document::csvField(model.name));
}

namespace {

constexpr long kHeld = 2;  ///< status of a good answer whose foot is kept by a held contact

long statusOf(const servo::ModelState& model, const hsp_contact& contact, bool probe_valid) {
  if (!probe_valid) return HSP_E_NUMERIC;
  return model.status == HSP_OK && (contact.flags & HSP_OUT_HELD) != 0 ? kHeld : model.status;
}

}  // namespace

TraceWriter::~TraceWriter() {
  if (out_ == nullptr || out_ == stdout) return;
  std::fclose(out_);
  removeIncomplete(file_);
}

void TraceWriter::number(double value) {
  char text[32];
  const int length =
      std::isnan(value) ? std::snprintf(text, sizeof text, ",nan") : std::snprintf(text, sizeof text, ",%.17g", value);
  line_.append(text, static_cast<size_t>(length));
}

void TraceWriter::numbers(const double* values, int count) {
  for (int i = 0; i < count; ++i) number(values[i]);
}

void TraceWriter::whole(long value) {
  (line_ += ',') += std::to_string(value);
}

Result<void> TraceWriter::write(double t, const servo::Core& core, bool probe_valid) {
  constexpr double kNothing = std::numeric_limits<double>::quiet_NaN();
  for (const uint32_t index : models_) {
    const servo::ModelState& model = core.models()[index];
    const servo::Contact& contact = core.contact(index, 0);
    const hsp_contact& c = contact.world;
    line_ = withDigits(t, 17);
    (line_ += ',') += names_[index];
    if (contact.traced) {
      whole(c.feature);
      numbers(c.param, 2);
      numbers(c.point, 3);
      numbers(c.normal, 3);
      number(c.depth_m);
    } else {
      for (int i = 0; i < 10; ++i) number(kNothing);
    }
    numbers(c.force, 3);
    numbers(c.torque, 3);
    whole(contact.traced && c.depth_m > 0 ? 1 : 0);
    whole(c.iterations);
    whole(statusOf(model, c, probe_valid));
    numbers(model.pose.position, 3);
    numbers(model.pose.orientation, 4);
    line_ += '\n';
    if (std::fwrite(line_.data(), 1, line_.size(), out_) != line_.size())
      return Error{file_ + ": cannot be written: " + std::strerror(errno)};
  }
  return {};
}

Result<void> TraceWriter::close() {
  std::FILE* out = out_;
  out_ = nullptr;
  const bool failed = std::fflush(out) != 0 || std::ferror(out) != 0 || (out != stdout && std::fclose(out) != 0);
  if (!failed) return {};
  const int code = errno;
  removeIncomplete(file_);
  return Error{file_ + ": cannot be written: " + std::strerror(code)};
}

}  // namespace hapticd::cli
