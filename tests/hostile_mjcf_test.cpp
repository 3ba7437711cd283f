// Hostile files: MJCF whose numbers and amounts cannot be had.
#include "tests/hostile_files.hpp"

namespace mjarm::hostile {
namespace {

std::string with_option(const std::string& timestep) {
  return mjcf("<geom size=\"1\"/>", "<option timestep=\"" + timestep + "\"/>");
}

std::string with_size(const std::string& size) {
  return mjcf("<body><joint/><geom size=\"1\"/></body>", "<size " + size + "/>");
}

std::string replicates(int depth, const std::string& count) {
  return mjcf(repeat("<replicate count=\"" + count + "\" offset=\"1 0 0\">", depth) +
              "<geom size=\"1\"/>" + repeat("</replicate>", depth));
}

std::string moving(const std::string& attributes) {
  return mjcf("<body name=\"b\" " + attributes + "><joint/><geom size=\"1\"/></body>");
}

/// Each of them alone could be had.
std::string large_textures(int count) {
  std::string all;
  for (int i = 0; i < count; ++i) {
    all += "<texture name=\"" + std::to_string(i) +
           "\" type=\"2d\" builtin=\"flat\" width=\"8000\" height=\"8000\"/>";
  }
  return all;
}

/// Two hinges, and keyframes for them.
std::string with_keys(const std::string& keys) {
  const std::string body = "<body><joint/><geom size=\"1\"/></body>";
  return "<mujoco><worldbody>" + body + body + "</worldbody>\n<keyframe>" + keys +
         "</keyframe></mujoco>";
}

}  // namespace

std::vector<HostileFile> hostile_mjcf() {
  return {
      {"ReplicateThousandToTheFourth",
       "a.xml",
       replicates(4, "1000"),
       {"a.xml:3: <replicate>", "elements"}},
      {"ReplicateBillion", "a.xml", replicates(1, "1000000000"), {"<replicate>", "1000000000"}},
      {"ReplicateTwiceNinetyDeep", "a.xml", replicates(90, "2"), {"<replicate>", "elements"}},
      {"ReplicateOfAnInclude",
       "a.xml",
       mjcf("<replicate count=\"1000\"><include file=\"many.xml\"/></replicate>"),
       {"a.xml:3: <replicate>", "elements"},
       [](const support::TempFolder& folder) {
         folder.write("many.xml", "<mujocoinclude>" + repeat("<site/>", 1000) + "</mujocoinclude>");
       }},
      {"TimestepNan", "a.xml", with_option("nan"), {"a.xml:2: <option>", "\"timestep\"", "finite"}},
      {"TimestepInfinite", "a.xml", with_option("inf"), {"a.xml:2: <option>", "finite"}},
      {"TimestepZero", "a.xml", with_option("0"), {"a.xml:2: <option>", "above 0"}},
      {"TimestepNegative", "a.xml", with_option("-0.002"), {"a.xml:2", "-0.002", "above 0"}},
      {"TimestepOfAges", "a.xml", with_option("1e308"), {"a.xml:2: <option>", "too large"}},
      {"TimestepOfAMinute", "a.xml", with_option("60"), {"a.xml:2: <option>", "60"}},
      {"TimestepIsText", "a.xml", with_option("fast"), {"a.xml:2: <option>", "timestep"}},
      {"PositionNan",
       "a.xml",
       moving("pos=\"0 nan 0\""),
       {"a.xml:3: <body \"b\">", "\"pos\"", "nan", "finite"}},
      {"PositionInfinite", "a.xml", moving("pos=\"0 0 -inf\""), {"a.xml:3: <body \"b\">", "-inf"}},
      {"PositionInWords", "a.xml", moving("pos=\"0 0 Infinity\""), {"a.xml:3", "Infinity"}},
      {"PositionFarAway", "a.xml", moving("pos=\"1e300 0 0\""), {"a.xml:3", "1e300", "too large"}},
      {"QuaternionNan", "a.xml", moving("quat=\"nan 0 0 1\""), {"a.xml:3", "\"quat\"", "finite"}},
      {"SizeHuge",
       "a.xml",
       mjcf("<body><joint/>\n<geom size=\"1e308\"/></body>"),
       {"a.xml:4: <geom>", "1e308", "too large"}},
      {"SizeBeyondDouble",
       "a.xml",
       mjcf("<geom size=\"1e999\"/>"),
       {"a.xml:3: <geom>", "too large"}},
      {"SizeNan", "a.xml", mjcf("<geom size=\"nan\"/>"), {"a.xml:3: <geom>", "finite"}},
      {"SizeInADefault",
       "a.xml",
       mjcf("<geom/>", "<default><geom size=\"1e200\"/></default>"),
       {"a.xml:2: <geom>", "1e200"}},
      {"MassHuge",
       "a.xml",
       mjcf("<body><joint/><geom size=\"1\" mass=\"1e300\"/></body>"),
       {"a.xml:3", "\"mass\"", "1e300"}},
      {"DensityNegative",
       "a.xml",
       mjcf("<body><joint/><geom size=\"1\" density=\"-5\"/></body>"),
       {"a.xml"}},
      {"InertiaNan",
       "a.xml",
       mjcf("<body><joint/><inertial pos=\"0 0 0\" mass=\"1\" diaginertia=\"1 nan 1\"/></body>"),
       {"a.xml:3", "\"diaginertia\"", "finite"}},
      {"GravityInfinite",
       "a.xml",
       mjcf("<geom size=\"1\"/>", "<option gravity=\"0 0 -inf\"/>"),
       {"a.xml:2: <option>", "\"gravity\""}},
      {"GravityHuge",
       "a.xml",
       mjcf("<geom size=\"1\"/>", "<option gravity=\"0 0 -1e300\"/>"),
       {"a.xml:2", "1e300"}},
      {"DampingNan",
       "a.xml",
       mjcf("<body><joint damping=\"nan\"/><geom size=\"1\"/></body>"),
       {"a.xml:3: <joint>", "\"damping\""}},
      {"GainHuge",
       "a.xml",
       "<mujoco><worldbody><body><joint name=\"j\"/><geom size=\"1\"/></body></worldbody>\n"
       "<actuator><position joint=\"j\" kp=\"1e200\"/></actuator></mujoco>",
       {"a.xml:2: <position>", "\"kp\"", "1e200"}},
      {"HeightFieldGigantic",
       "a.xml",
       with_asset("<hfield name=\"h\" nrow=\"100000\" ncol=\"100000\" size=\"1 1 1 1\"/>"),
       {"a.xml:2: <hfield \"h\">", "10000000000", "at most"}},
      {"HeightFieldNegative",
       "a.xml",
       with_asset("<hfield name=\"h\" nrow=\"-5\" ncol=\"-5\" size=\"1 1 1 1\"/>"),
       {"a.xml"}},
      {"HeightFieldOfOverflow",
       "a.xml",
       with_asset("<hfield name=\"h\" nrow=\"65536\" ncol=\"65536\" size=\"1 1 1 1\"/>"),
       {"a.xml:2: <hfield \"h\">"}},
      {"TextureGigantic",
       "a.xml",
       with_asset("<texture name=\"t\" type=\"2d\" builtin=\"flat\" width=\"100000\" "
                  "height=\"100000\"/>"),
       {"a.xml:2: <texture \"t\">", "10000000000"}},
      {"TextureOfTwoBillionColumns",
       "a.xml",
       with_asset("<texture name=\"t\" type=\"cube\" builtin=\"gradient\" width=\"2000000000\" "
                  "height=\"1\"/>"),
       {"a.xml:2: <texture \"t\">"}},
      {"TextureNegative",
       "a.xml",
       with_asset("<texture name=\"t\" type=\"2d\" builtin=\"flat\" width=\"-4\" height=\"4\"/>"),
       {"a.xml"}},
      {"ManyLargeTextures",
       "a.xml",
       with_asset(large_textures(40)),
       {"a.xml:2: <texture \"1\">", "128000000"}},
      {"MemoryOfTenPetabytes", "a.xml", with_size("memory=\"10P\""), {"a.xml", "memory"}},
      {"MemoryOfAHundredGigabytes", "a.xml", with_size("memory=\"100G\""), {"a.xml", "memory"}},
      {"MemoryNegative", "a.xml", with_size("memory=\"-5M\""), {"a.xml:2: <size>"}},
      {"TwoBillionKeyframes",
       "a.xml",
       with_size("nkey=\"2000000000\""),
       {"a.xml:2: <size>", "nkey", "2000000000"}},
      {"TwoBillionUserData",
       "a.xml",
       with_size("nuserdata=\"2000000000\""),
       {"a.xml:2: <size>", "nuserdata"}},
      {"TwoBillionUserBodies",
       "a.xml",
       with_size("nuser_body=\"2000000000\""),
       {"a.xml:2: <size>", "nuser_body"}},
      {"FlexibleBodyGigantic",
       "a.xml",
       mjcf("<flexcomp name=\"f\" type=\"grid\" dim=\"3\" count=\"10000 10000 10000\" "
            "spacing=\"1 1 1\"/>"),
       {"a.xml:3: <flexcomp \"f\">", "count", "1000000000000"}},
      {"FlexibleBodyLarge",
       "a.xml",
       mjcf("<flexcomp name=\"f\" type=\"grid\" dim=\"3\" count=\"90 90 90\" spacing=\".1 .1 .1\" "
            "radius=\".01\" mass=\"1\"/>"),
       {"a.xml", "reading the description", "more than 3 s"}},
      {"SensorGigantic",
       "a.xml",
       "<mujoco>\n<sensor><user dim=\"2000000000\"/></sensor></mujoco>",
       {"a.xml:2: <user>", "dim"}},
      {"HistoryGigantic",
       "a.xml",
       "<mujoco>\n<sensor><clock nsample=\"2000000000\" interval=\"1\"/></sensor></mujoco>",
       {"a.xml:2: <clock>", "nsample"}},
      {"NumericGigantic",
       "a.xml",
       "<mujoco>\n<custom><numeric name=\"n\" size=\"2000000000\"/></custom></mujoco>",
       {"a.xml:2: <numeric \"n\">"}},
      {"OffscreenGigantic",
       "a.xml",
       "<mujoco>\n<visual><global offwidth=\"2000000000\"/></visual></mujoco>",
       {"a.xml:2: <global>", "offwidth"}},
      {"SlicesGigantic",
       "a.xml",
       "<mujoco>\n<visual><quality numslices=\"2000000000\"/></visual></mujoco>",
       {"a.xml:2: <quality>", "numslices"}},
      {"MeshIndexOutOfRange",
       "a.xml",
       with_asset("<mesh name=\"m\" vertex=\"0 0 0 1 0 0 0 1 0 0 0 1\" face=\"0 1 2000000000\"/>"),
       {"a.xml"}},
      {"MeshVertexNan",
       "a.xml",
       with_asset("<mesh name=\"m\" vertex=\"0 0 0 1 0 nan 0 1 0 0 0 1\"/>"),
       {"a.xml:2: <mesh \"m\">", "\"vertex\"", "finite"}},
      {"MeshWithoutVolume",
       "a.xml",
       mjcf("<body><joint/><geom type=\"mesh\" mesh=\"m\"/></body>",
            "<asset><mesh name=\"m\" vertex=\"0 0 0 1 0 0 0 1 0 1 1 0\"/></asset>"),
       {"a.xml"}},
      {"KeyframeTooLong",
       "a.xml",
       with_keys("<key name=\"home\" qpos=\"1 2 3\"/>"),
       {"a.xml:2", "home", "qpos"}},
      {"KeyframeNan",
       "a.xml",
       with_keys("<key name=\"home\" qpos=\"nan 1\"/>"),
       {"a.xml:2: <key \"home\">", "\"qpos\"", "finite"}},
      {"UnknownPlugin",
       "a.xml",
       "<mujoco>\n<extension><plugin plugin=\"no.such.thing\"/></extension></mujoco>",
       {"a.xml", "no.such.thing"}},
      {"ModelContainsItself",
       "a.xml",
       "<mujoco><asset>\n<model name=\"m\" file=\"a.xml\"/></asset><worldbody><attach model=\"m\" "
       "body=\"world\" prefix=\"p\"/></worldbody></mujoco>",
       {"a.xml:2: <model \"m\">", "contains itself"}},
      {"ModelsContainEachOther",
       "a.xml",
       "<mujoco><asset>\n<model name=\"m\" file=\"b.xml\"/></asset></mujoco>",
       {"b.xml:2: <model \"m\">", "contains itself"},
       [](const support::TempFolder& folder) {
         folder.write("b.xml",
                      "<mujoco><asset>\n<model name=\"m\" file=\"a.xml\"/></asset></mujoco>");
       }},
      {"TimestepZeroInAnInclude",
       "a.xml",
       "<mujoco><include file=\"b.xml\"/></mujoco>",
       {"b.xml:2: <option>", "above 0"},
       [](const support::TempFolder& folder) {
         folder.write("b.xml", "<mujoco>\n<option timestep=\"0\"/></mujoco>");
       }},
  };
}

}  // namespace mjarm::hostile
