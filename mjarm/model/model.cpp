#include "mjarm/model/model.hpp"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "mjarm/core/messages/model.hpp"
#include "mjarm/core/utf8.hpp"
#include "mjarm/model/arm_parts_internal.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/mujoco_guard.hpp"
#include "mjarm/model/point_mass_internal.hpp"
#include "mjarm/model/preflight_internal.hpp"

namespace mjarm {
namespace fs = std::filesystem;

struct Model::Impl {
  fs::path file;
  ModelFormat format = ModelFormat::mjcf;
  LoadedModel loaded;
};

namespace {

/// `words` without what would break a line of a terminal, and cut where it is endless.
std::string one_line(std::string_view words) {
  constexpr std::size_t kLongest = 1000;
  std::string line;
  while (!words.empty() && line.size() < kLongest) {
    const std::size_t length = utf8_length(words);
    const auto first = static_cast<unsigned char>(words.front());
    if (length == 0 || first < 0x20 || first == 0x7f) {
      line += length == 0 ? '?' : ' ';
    } else {
      line += words.substr(0, length);
    }
    words.remove_prefix(std::max<std::size_t>(length, 1));
  }
  if (!words.empty()) line += "...";
  return line;
}

/// MJCF or URDF, by the root element.
Result<ModelFormat> format_of(const XmlSources& files) {
  const XmlSources::Document& main = *files.documents().front();
  const tinyxml2::XMLElement& root = *main.xml.RootElement();
  const std::string_view name = root.Name();
  if (name == "robot") return ModelFormat::urdf;
  if (name == "mujoco") return ModelFormat::mjcf;
  const Msg reason = name == "mujocoinclude" ? msg::model_is_a_part : msg::model_wrong_root;
  return fail(Errc::bad_input, text(reason, main.name, root.GetLineNum(), name));
}

}  // namespace

Model::Model(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

Result<Model> Model::load(const fs::path& file, const LoadOptions& options) {
  install_mujoco_handler();
  Result<Model> model = load_guarded(file, options);
  if (!model) model.error().what = one_line(model.error().what);
  return model;
}

Result<Model> Model::from_mjcf(const std::string& text) {
  install_mujoco_handler();
  Result<LoadedModel> loaded = compile_text(text);
  if (!loaded) return fail(loaded.error().code, one_line(loaded.error().what));
  return Model(std::make_shared<const Impl>(Impl{{}, ModelFormat::mjcf, std::move(*loaded)}));
}

Model Model::copy_of(const mjModel_* model) {
  install_mujoco_handler();
  LoadedModel copy;
  copy.model.reset(mj_copyModel(nullptr, model));
  return Model(std::make_shared<const Impl>(Impl{{}, ModelFormat::mjcf, std::move(copy)}));
}

Result<Model> Model::load_guarded(const fs::path& file, LoadOptions options) {
  try {
    if (is_shipped(file)) options.trusted = options.allow_outside = true;
    const XmlSources files(file, options.allow_outside);
    if (files.documents().empty()) return fail(*files.fault());
    const Result<ModelFormat> format = format_of(files);
    if (!format) return fail(format.error());
    if (auto done = preflight(files, options); !done) return fail(done.error());
    Result<LoadedModel> loaded =
        *format == ModelFormat::urdf
            ? load_urdf(files, options)
            : compile_spec({.files = files, .trusted = options.trusted, .looks = options.looks});
    if (!loaded) return fail(std::move(loaded.error()));
    return Model(std::make_shared<const Impl>(Impl{file, *format, std::move(*loaded)}));
  } catch (const std::exception& problem) {
    return fail(Errc::bad_input, text(msg::model_unexpected, file.string(), problem.what()));
  }
}

std::shared_ptr<Model::Impl> Model::own_copy() const {
  const LoadedModel& own = impl_->loaded;
  return std::make_shared<Impl>(
      Impl{impl_->file,
           impl_->format,
           {MjModelPtr(mj_copyModel(nullptr, raw())), own.velocity_limits, own.effort_limits,
            own.warnings, own.read_files, own.urdf_text}});
}

Result<Model> Model::with_point_mass(std::string_view frame, double mass) const {
  if (!(mass > 0) || !std::isfinite(mass)) {
    return fail(Errc::bad_input, text(msg::model_bad_mass, mass));
  }
  const Result<TipFrame> found = find_frame(*this, frame);
  if (!found) return fail(found.error());
  if (found->body == 0) return fail(Errc::bad_input, text(msg::model_mass_on_world, frame));
  const std::shared_ptr<Impl> impl = own_copy();
  detail::add_point_mass(*impl->loaded.model, found->body, found->X_BT.p, mass);
  return Model(impl);
}

Result<Model> Model::with_physics(const PhysicsChange& change) const {
  const auto is_wrong = [](const std::optional<double>& value, bool zero) {
    return value && !(std::isfinite(*value) && (*value > 0 || (zero && *value == 0)));
  };
  if (is_wrong(change.timestep, false)) {
    return fail(Errc::bad_input, text(msg::model_bad_step, *change.timestep));
  }
  if (is_wrong(change.friction, true)) {
    return fail(Errc::bad_input, text(msg::model_bad_friction, *change.friction));
  }
  const std::shared_ptr<Impl> impl = own_copy();
  mjModel& m = *impl->loaded.model;
  m.opt.timestep = change.timestep.value_or(m.opt.timestep);
  const double factor = change.friction.value_or(1);
  for (mjtNum& value : std::span(m.geom_friction, 3 * static_cast<std::size_t>(m.ngeom))) {
    value *= factor;
  }
  for (mjtNum& value : std::span(m.pair_friction, 5 * static_cast<std::size_t>(m.npair))) {
    value *= factor;
  }
  return Model(impl);
}

const fs::path& Model::file() const noexcept { return impl_->file; }
ModelFormat Model::format() const noexcept { return impl_->format; }
std::string_view Model::name() const noexcept { return raw()->names; }
double Model::timestep() const noexcept { return raw()->opt.timestep; }
int Model::nq() const noexcept { return static_cast<int>(raw()->nq); }
int Model::nv() const noexcept { return static_cast<int>(raw()->nv); }
int Model::nu() const noexcept { return static_cast<int>(raw()->nu); }

std::span<const double> Model::qpos0() const noexcept {
  return {raw()->qpos0, static_cast<std::size_t>(raw()->nq)};
}

double Model::urdf_velocity_limit(std::string_view joint) const noexcept {
  const auto found = impl_->loaded.velocity_limits.find(joint);
  return found == impl_->loaded.velocity_limits.end() ? 0.0 : found->second;
}

double Model::urdf_effort_limit(std::string_view joint) const noexcept {
  const auto found = impl_->loaded.effort_limits.find(joint);
  return found == impl_->loaded.effort_limits.end() ? 0.0 : found->second;
}

std::span<const std::string> Model::warnings() const noexcept { return impl_->loaded.warnings; }

const mjModel_* Model::raw() const noexcept { return impl_->loaded.model.get(); }
const std::string& Model::urdf_text() const noexcept { return impl_->loaded.urdf_text; }

}  // namespace mjarm
