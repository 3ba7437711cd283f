#pragma once

#include <stdexcept>
#include <string>
#include <vector>

#include "apps/mjarm/commands/program_test.hpp"

namespace mjarm::app {

/// What `who` did on `set`, in the JSON document of a suite with one robot.
inline const nlohmann::json& run_of(const nlohmann::json& bench, const std::string& who,
                                    const std::string& set) {
  for (const nlohmann::json& run : bench.at("robots").at(0).at("runs")) {
    if (run.value("who", "") == who && run.value("set", "") == set) return run;
  }
  throw std::runtime_error("no run of " + who + " on " + set);
}

/// Arguments of `mjarm bench SUITE` for the robot `arm` of the folder `data`.
inline std::vector<std::string> bench_arm(const std::string& suite, const std::string& data,
                                          const std::vector<std::string>& more) {
  std::vector<std::string> arguments = {"bench", suite, "--robot", "arm", "--data", data};
  arguments.insert(arguments.end(), more.begin(), more.end());
  return arguments;
}

/// The JSON document of a run of `mjarm bench` that has to end well.
inline nlohmann::json bench_json(std::vector<std::string> arguments) {
  arguments.emplace_back("--json");
  const support::ProgramResult result = mjarm(arguments);
  EXPECT_EQ(result.exit_code, 0) << result.err;
  return nlohmann::json::parse(result.out);
}

/// Writes `arm.urdf`: two hinges j1 and j2 about z, two links of 1 m, the frame `tool`.
inline void write_planar_arm(const support::TempFolder& folder) {
  folder.write("arm.urdf", R"(<robot name="arm"><link name="base"/><link name="a"/><link name="b"/>
<link name="tool"/>
<joint name="j1" type="revolute"><parent link="base"/><child link="a"/><axis xyz="0 0 1"/>
<limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
<joint name="j2" type="revolute"><origin xyz="1 0 0"/><parent link="a"/><child link="b"/>
<axis xyz="0 0 1"/><limit lower="-3" upper="3" effort="1" velocity="1"/></joint>
<joint name="tip" type="fixed"><origin xyz="1 0 0"/><parent link="b"/><child link="tool"/></joint>
</robot>)");
}

/// Writes a Python environment whose Python gives these answers, one JSON object a line.
/// @param check  shell commands run before; $2 is the job.
inline std::string write_peers(const support::TempFolder& folder, const std::string& answers,
                               const std::string& check = "") {
  const auto python = folder.write(
      "venv/bin/python", "#!/bin/sh\n" + check + "\ngrep . > \"$3\" <<'END'" + answers + "END\n");
  std::filesystem::permissions(python, std::filesystem::perms::owner_all);
  return (folder.path() / "venv").string();
}

}  // namespace mjarm::app
