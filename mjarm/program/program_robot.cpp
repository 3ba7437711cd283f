#include "mjarm/core/messages/program.hpp"
#include "mjarm/core/yaml_tree.hpp"
#include "mjarm/model/find_arm.hpp"
#include "mjarm/program/program_plan.hpp"

namespace mjarm::program {
namespace {

/// A path of a program: from its folder, or a name that a model is known by.
Result<std::filesystem::path> find(const std::string& name, const std::filesystem::path& file) {
  const std::filesystem::path beside = file.parent_path() / name;
  std::error_code code;
  if (std::filesystem::is_regular_file(beside, code)) return beside;
  return find_model_file(name);
}

}  // namespace

Result<Robot, ProgramFault> load_robot_of(const Program& program, const std::filesystem::path& file,
                                          const LoadOptions& load) {
  const bool scene = !program.scene.empty();
  const FilePlace place = scene ? program.scene_place : program.robot_place;
  const auto fault = [&](const Error& error, FilePlace at) {
    return tl::unexpected(
        ProgramFault{at, scene ? "scene" : "robot", "bad_input", error.what, error.code});
  };
  const Result<std::filesystem::path> found = find(scene ? program.scene : program.robot, file);
  if (!found) return fault(found.error(), place);
  Result<Model> model = Model::load(*found, load);
  if (!model) return fault(model.error(), place);
  Result<Arm> arm = find_arm(*model, {.tip = program.tool});
  if (!arm) return fault(arm.error(), program.tool.empty() ? place : program.tool_place);
  return Robot{std::move(*model), std::move(*arm)};
}

Result<Robot> load_program_robot(const Program& program, const std::filesystem::path& file,
                                 const LoadOptions& load) {
  return load_robot_of(program, file, load).map_error([&](const ProgramFault& fault) {
    return Error{fault.code, at_place(file.string(), fault.place, fault.what)};
  });
}

}  // namespace mjarm::program
