#include "mjarm/model/model.hpp"

#include <tinyxml2.h>

#include <exception>
#include <utility>

#include "mjarm/core/file.hpp"
#include "mjarm/core/messages/model.hpp"
#include "mjarm/model/load_internal.hpp"
#include "mjarm/model/mujoco_guard.hpp"

namespace mjarm {
namespace fs = std::filesystem;

struct Model::Impl {
  fs::path file;
  ModelFormat format = ModelFormat::mjcf;
  LoadedModel loaded;
};

namespace {

/// Largest text of a description that is read [bytes]; meshes are other files.
constexpr std::size_t kMaxXmlBytes = std::size_t{64} << 20;

Error xml_error(const fs::path& file, const tinyxml2::XMLDocument& document) {
  const std::string name = file.string();
  if (document.ErrorID() == tinyxml2::XML_ERROR_EMPTY_DOCUMENT) {
    return {Errc::bad_input, text(msg::model_empty_file, name)};
  }
  std::string detail;
  switch (document.ErrorID()) {
    case tinyxml2::XML_ERROR_MISMATCHED_ELEMENT:
      detail = text(msg::model_xml_mismatch);
      break;
    case tinyxml2::XML_ERROR_PARSING_ATTRIBUTE:
      detail = text(msg::model_xml_attribute);
      break;
    case tinyxml2::XML_ELEMENT_DEPTH_EXCEEDED:
      detail = text(msg::model_xml_depth);
      break;
    default:
      detail = text(msg::model_xml_other);
  }
  // "Error=... ErrorID=14 (0xe) Line number=2: XMLElement name=body"
  const std::string full = document.ErrorStr();
  if (const std::size_t at = full.find("XMLElement name="); at != std::string::npos) {
    detail = "<" + full.substr(at + 16) + ">: " + detail;
  }
  return {Errc::bad_input, text(msg::model_not_xml, name, document.ErrorLineNum(), detail)};
}

}  // namespace

Model::Model(std::shared_ptr<const Impl> impl) : impl_(std::move(impl)) {}

Result<Model> Model::load(const fs::path& file, const LoadOptions& options) {
  install_mujoco_handler();
  try {
    const Result<std::string> content = read_file(file, kMaxXmlBytes);
    if (!content) return fail(content.error());
    tinyxml2::XMLDocument document;
    if (document.Parse(content->data(), content->size()) != tinyxml2::XML_SUCCESS) {
      return fail(xml_error(file, document));
    }
    const tinyxml2::XMLElement* root = document.RootElement();
    if (root == nullptr) {
      return fail(Errc::bad_input, text(msg::model_empty_file, file.string()));
    }
    const std::string_view root_name = root->Name();
    auto impl = std::make_shared<Impl>();
    impl->file = file;
    impl->format = root_name == "robot" ? ModelFormat::urdf : ModelFormat::mjcf;
    if (root_name != "robot" && root_name != "mujoco") {
      const Msg reason =
          root_name == "mujocoinclude" ? msg::model_is_a_part : msg::model_wrong_root;
      return fail(Errc::bad_input, text(reason, file.string(), root->GetLineNum(), root_name));
    }
    Result<LoadedModel> loaded = impl->format == ModelFormat::urdf
                                     ? load_urdf(file, document, options)
                                     : compile_spec({.file = file}, nullptr);
    if (!loaded) return fail(std::move(loaded.error()));
    impl->loaded = std::move(*loaded);
    return Model(std::move(impl));
  } catch (const std::exception& problem) {
    return fail(Errc::system, text(msg::model_unexpected, file.string(), problem.what()));
  }
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
