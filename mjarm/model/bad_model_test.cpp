// Files that must be refused: one line, with the file, the line, the element and what is wrong.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <filesystem>

#include "mjarm/core/messages.hpp"
#include "mjarm/model/model.hpp"
#include "tests/support/temp_folder.hpp"

namespace mjarm {
namespace {

using ::testing::HasSubstr;
using ::testing::StartsWith;

/// A file and what its error must say.
struct BadFile {
  const char* label;
  const char* file;
  const char* content;
  const char* place;               ///< after the file's path
  std::vector<const char*> words;  ///< all of these must be there
};

void PrintTo(const BadFile& bad, std::ostream* out) { *out << bad.label; }

class BadModel : public ::testing::TestWithParam<BadFile> {};

TEST_P(BadModel, IsRefusedInOneLine) {
  const BadFile& bad = GetParam();
  const support::TempFolder folder;
  folder.write("part.xml",
               "<mujoco>\n\n<worldbody>\n<geom size=\"1\" tipe=\"box\"/>\n</worldbody></mujoco>");
  folder.write("gone.xml",
               "<mujoco>\n<asset>\n<mesh name=\"m\" file=\"gone.obj\"/></asset></mujoco>");
  const std::filesystem::path file = folder.write(bad.file, bad.content);
  const auto model = Model::load(file);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().code, Errc::bad_input);
  const std::string& what = model.error().what;
  EXPECT_EQ(what.find('\n'), std::string::npos) << what;
  EXPECT_THAT(what, StartsWith((folder.path() / bad.place).string()));
  for (const char* word : bad.words) EXPECT_THAT(what, HasSubstr(word));

  set_language(Language::chinese);
  const auto again = Model::load(file);
  set_language(Language::english);
  ASSERT_FALSE(again);
  EXPECT_NE(again.error().what, what);  // every message stands in both languages
  const std::string place =
      std::string(bad.place).substr(0, std::string(bad.place).find(": "));  // file and line
  EXPECT_THAT(again.error().what, StartsWith((folder.path() / place).string()));
  EXPECT_FALSE(std::filesystem::exists("MUJOCO_LOG.TXT"));
}

constexpr const char* kArm =
    "<mujoco>\n<worldbody>\n<body name=\"a\">\n<joint name=\"hip\"/>\n<geom size=\"1\"/>\n"
    "</body></worldbody>\n";

INSTANTIATE_TEST_SUITE_P(
    Mjcf, BadModel,
    ::testing::Values(
        BadFile{"Empty", "a.xml", "", "a.xml", {"is empty"}},
        BadFile{"OnlyAComment", "a.xml", "<!-- nothing -->", "a.xml", {"is empty"}},
        BadFile{"NotXml", "a.xml", "\nsolid cube", "a.xml:", {"XML"}},
        BadFile{"Unclosed",
                "a.xml",
                "<mujoco>\n<worldbody><body></worldbody></mujoco>",
                "a.xml:2",
                {"<body>", "do not match"}},
        BadFile{"Truncated", "a.xml", "<mujoco>\n<worldbody>\n<bo", "a.xml:", {"XML"}},
        BadFile{
            "Attribute", "a.xml", "<mujoco model=3/>", "a.xml:1", {"<mujoco>", "name=\"value\""}},
        BadFile{"WrongRoot", "a.xml", "<sdf>\n</sdf>", "a.xml:1", {"<sdf>", "<mujoco>", "<robot>"}},
        BadFile{"Part", "a.xml", "<mujocoinclude/>", "a.xml:1", {"included by another"}},
        BadFile{"UnknownAttribute",
                "a.xml",
                "<mujoco><worldbody>\n<geom sise=\"1\"/></worldbody></mujoco>",
                "a.xml:2: <geom>",
                {"\"sise\"", "did you mean \"size\""}},
        BadFile{"UnknownElement",
                "a.xml",
                "<mujoco><worldbody>\n<gem size=\"1\"/></worldbody></mujoco>",
                "a.xml:2: <gem>",
                {"not known", "did you mean \"geom\""}},
        BadFile{"UnknownKeyword",
                "a.xml",
                "<mujoco>\n\n<compiler angle=\"rad\"/></mujoco>",
                "a.xml:3: <compiler>",
                {"\"rad\""}},
        BadFile{"NotANumber",
                "a.xml",
                "<mujoco><worldbody>\n<geom size=\"big\"/></worldbody></mujoco>",
                "a.xml:2: <geom>",
                {"\"size\""}},
        BadFile{"TooManyNumbers",
                "a.xml",
                "<mujoco><worldbody>\n<geom size=\"1 2 3 4\"/></worldbody></mujoco>",
                "a.xml:2: <geom>",
                {"more numbers"}},
        BadFile{"HugeNumber",
                "a.xml",
                "<mujoco><worldbody>\n<geom size=\"1e999\"/></worldbody></mujoco>",
                "a.xml:2: <geom>",
                {"too large"}},
        BadFile{"NoSize",
                "a.xml",
                "<mujoco><worldbody>\n<geom/>\n</worldbody></mujoco>",
                "a.xml:2: <geom>",
                {"must be above 0"}},
        BadFile{"Nan",
                "a.xml",
                "<mujoco><worldbody>\n<body pos=\"0 nan 0\">\n<joint/><geom "
                "size=\"1\"/></body></worldbody></mujoco>",
                "a.xml:2: <body>",
                {"\"pos\"", "finite"}},
        BadFile{"NoMass",
                "a.xml",
                "<mujoco><worldbody>\n<body name=\"b\">\n<joint/></body></worldbody></mujoco>",
                "a.xml:2: <body \"b\">",
                {"mass and inertia"}},
        BadFile{"ImpossibleInertia",
                "a.xml",
                "<mujoco><worldbody>\n<body name=\"b\">\n<inertial pos=\"0 0 0\" mass=\"1\" "
                "diaginertia=\"1 1 5\"/>\n<joint/></body></worldbody></mujoco>",
                "a.xml:2: <body \"b\">",
                {"principal moments"}},
        BadFile{"RepeatedName",
                "a.xml",
                "<mujoco><worldbody>\n<geom name=\"g\" size=\"1\"/>\n<geom name=\"g\" "
                "size=\"1\"/></worldbody></mujoco>",
                "a.xml:3: <geom>",
                {"\"g\"", "twice"}},
        BadFile{"CrossedRange",
                "a.xml",
                "<mujoco><worldbody>\n<body><geom size=\"1\"/>\n<joint name=\"j\" limited=\"true\" "
                "range=\"1 -1\"/></body></worldbody></mujoco>",
                "a.xml:3: <joint \"j\">",
                {"below"}},
        BadFile{"NoAxis",
                "a.xml",
                "<mujoco><worldbody>\n<body><geom size=\"1\"/>\n<joint axis=\"0 0 "
                "0\"/></body></worldbody></mujoco>",
                "a.xml:3: <joint>",
                {"no length"}},
        BadFile{"ZeroQuat",
                "a.xml",
                "<mujoco><worldbody>\n<body quat=\"0 0 0 0\"/></worldbody></mujoco>",
                "a.xml:2: <body>",
                {"no rotation"}},
        BadFile{"FreeJointInside",
                "a.xml",
                "<mujoco><worldbody>\n<body>\n<body>\n<freejoint/>\n<geom "
                "size=\"1\"/></body></body></worldbody></mujoco>",
                "a.xml:",
                {"free joint"}},
        BadFile{"NoMeshFile",
                "a.xml",
                "<mujoco><asset>\n<mesh name=\"m\" file=\"gone.obj\"/></asset></mujoco>",
                "a.xml:2: <mesh>",
                {"gone.obj", "cannot be opened"}},
        BadFile{
            "NoTexture",
            "a.xml",
            "<mujoco><asset>\n<texture name=\"t\" type=\"2d\" file=\"no.png\"/></asset></mujoco>",
            "a.xml:2: <texture>",
            {"no.png"}},
        BadFile{
            "NoMesh",
            "a.xml",
            "<mujoco><asset><mesh name=\"hand\" vertex=\"0 0 0 1 0 0 0 1 0 0 0 "
            "1\"/></asset><worldbody>\n<geom type=\"mesh\" mesh=\"hamd\"/></worldbody></mujoco>",
            "a.xml:2: <geom>",
            {"\"hamd\"", "did you mean \"hand\""}},
        BadFile{"NoClass",
                "a.xml",
                "<mujoco><default><default class=\"look\"/></default><worldbody>\n<geom "
                "class=\"lok\" size=\"1\"/></worldbody></mujoco>",
                "a.xml:2: <geom>",
                {"\"lok\"", "did you mean \"look\""}},
        BadFile{"NoInclude",
                "a.xml",
                "<mujoco>\n<include file=\"no.xml\"/></mujoco>",
                "a.xml:2: <include>",
                {"no.xml"}},
        BadFile{"IncludesItself",
                "a.xml",
                "<mujoco>\n<include file=\"a.xml\"/></mujoco>",
                "a.xml:2: <include>",
                {"includes itself"}},
        BadFile{"FaultInInclude",
                "a.xml",
                "<mujoco>\n<include file=\"part.xml\"/></mujoco>",
                "part.xml:4: <geom>",
                {"\"tipe\"", "did you mean \"type\""}},
        BadFile{"NoMeshFileInInclude",
                "a.xml",
                "<mujoco>\n<include file=\"gone.xml\"/></mujoco>",
                "gone.xml:3: <mesh>",
                {"gone.obj"}},
        BadFile{"TooMuchMemory",
                "a.xml",
                "<mujoco><size memory=\"10P\"/></mujoco>",
                "a.xml",
                {"memory"}},
        BadFile{"BackwardTime",
                "a.xml",
                "<mujoco><option timestep=\"-0.1\"/></mujoco>",
                "a.xml",
                {"-0.1", "above 0"}}),
    [](const auto& test) { return test.param.label; });

/// A URDF of two links, with other text in place of one part of it.
#define LINKS "<robot name=\"r\">\n<link name=\"base\"/>\n<link name=\"arm\"/>\n"
#define JOINT(type, inside)                                                                       \
  "<joint name=\"j\" type=\"" type "\">\n<parent link=\"base\"/>\n<child link=\"arm\"/>\n" inside \
  "</joint>\n</robot>"
#define LIMIT "<limit lower=\"-1\" upper=\"1\" velocity=\"1\" effort=\"1\"/>"

INSTANTIATE_TEST_SUITE_P(
    Urdf, BadModel,
    ::testing::Values(
        BadFile{"NoLinks", "a.urdf", "<robot name=\"r\"/>", "a.urdf:1: <robot \"r\">", {"<link>"}},
        BadFile{"LinkWithoutName",
                "a.urdf",
                "<robot name=\"r\">\n<link/></robot>",
                "a.urdf:2: <link",
                {"\"name\""}},
        BadFile{"RepeatedLink",
                "a.urdf",
                "<robot name=\"r\">\n<link name=\"a\"/>\n<link name=\"a\"/></robot>",
                "a.urdf:3: <link \"a\">",
                {"twice"}},
        BadFile{"TwoRoots",
                "a.urdf",
                "<robot name=\"r\">\n<link name=\"a\"/>\n<link name=\"b\"/></robot>",
                "a.urdf:3: <link \"b\">",
                {"no parent"}},
        BadFile{"JointType",
                "a.urdf",
                LINKS JOINT("revolut", LIMIT),
                "a.urdf:4: <joint \"j\">",
                {"\"revolut\"", "did you mean \"revolute\""}},
        BadFile{"NoType",
                "a.urdf",
                LINKS "<joint name=\"j\"/></robot>",
                "a.urdf:4: <joint \"j\">",
                {"\"type\""}},
        BadFile{"NoLimit",
                "a.urdf",
                LINKS JOINT("revolute", ""),
                "a.urdf:4: <joint \"j\">",
                {"<limit>"}},
        BadFile{"CrossedLimit",
                "a.urdf",
                LINKS JOINT("revolute", "<limit lower=\"2\" upper=\"1\"/>"),
                "a.urdf:7: <limit> of \"j\"",
                {"above the upper"}},
        BadFile{"NegativeVelocity",
                "a.urdf",
                LINKS JOINT("revolute", "<limit velocity=\"-1\"/>"),
                "a.urdf:7: <limit> of \"j\"",
                {"velocity"}},
        BadFile{"LimitIsText",
                "a.urdf",
                LINKS JOINT("revolute", "<limit effort=\"strong\"/>"),
                "a.urdf:7: <limit> of \"j\"",
                {"effort", "strong"}},
        BadFile{"InfiniteLimit",
                "a.urdf",
                LINKS JOINT("revolute", "<limit upper=\"inf\"/>"),
                "a.urdf:7: <limit> of \"j\"",
                {"upper", "finite"}},
        BadFile{"ZeroAxis",
                "a.urdf",
                LINKS JOINT("revolute", "<axis xyz=\"0 0 0\"/>\n" LIMIT),
                "a.urdf:7: <axis> of \"j\"",
                {"no length"}},
        BadFile{"ShortOrigin",
                "a.urdf",
                LINKS JOINT("fixed", "<origin xyz=\"1 2\"/>"),
                "a.urdf:7: <origin> of \"j\"",
                {"xyz", "3"}},
        BadFile{
            "UnknownLink",
            "a.urdf",
            "<robot name=\"r\">\n<link name=\"base\"/>\n<link name=\"arm\"/>\n<joint name=\"j\" "
            "type=\"fixed\">\n<parent link=\"bass\"/><child link=\"arm\"/></joint></robot>",
            "a.urdf:5: <parent> of \"j\"",
            {"\"bass\"", "did you mean \"base\""}},
        BadFile{"TwoParents",
                "a.urdf",
                LINKS "<joint name=\"i\" type=\"fixed\"><parent link=\"base\"/><child "
                      "link=\"arm\"/></joint>\n" JOINT("fixed", ""),
                "a.urdf:5: <joint \"j\">",
                {"\"arm\"", "two joints"}},
        BadFile{"Loop",
                "a.urdf",
                LINKS "<link name=\"c\"/>\n<joint name=\"i\" type=\"fixed\"><parent "
                      "link=\"arm\"/><child link=\"c\"/></joint>\n<joint name=\"j\" "
                      "type=\"fixed\"><parent link=\"c\"/><child link=\"arm\"/></joint></robot>",
                "a.urdf:3: <link \"arm\">",
                {"loop"}},
        BadFile{"NegativeMass",
                "a.urdf",
                "<robot name=\"r\">\n<link name=\"a\"><inertial>\n<mass "
                "value=\"-1\"/></inertial></link></robot>",
                "a.urdf:3: <mass> of \"a\"",
                {"negative"}},
        BadFile{"NoGeometry",
                "a.urdf",
                "<robot name=\"r\">\n<link name=\"a\">\n<visual/></link></robot>",
                "a.urdf:3: <visual> of \"a\"",
                {"<geometry>"}},
        BadFile{"NoMesh",
                "a.urdf",
                "<robot name=\"r\">\n<link name=\"a\">\n<visual><geometry>\n<mesh "
                "filename=\"package://gone/a.stl\"/></geometry></visual></link><link "
                "name=\"b\"/><joint name=\"j\" type=\"fixed\"><parent link=\"a\"/><child "
                "link=\"b\"/></joint></robot>",
                "a.urdf:4: <mesh> of \"a\"",
                {"package://gone/a.stl", "not found"}}),
    [](const auto& test) { return test.param.label; });

TEST(BadModelFile, MissingFolderAndDangling) {
  const support::TempFolder folder;
  const auto missing = Model::load(folder.path() / "no.xml");
  ASSERT_FALSE(missing);
  EXPECT_THAT(missing.error().what, HasSubstr("no.xml: no such file"));
  const auto directory = Model::load(folder.path());
  ASSERT_FALSE(directory);
  EXPECT_THAT(directory.error().what, HasSubstr("is a folder"));
  const auto empty_path = Model::load("");
  EXPECT_FALSE(empty_path);
}

TEST(BadModelFile, MotorWithoutJointNamesTheNearest) {
  const support::TempFolder folder;
  const auto file = folder.write(
      "a.xml", std::string(kArm) + "<actuator>\n<motor joint=\"hpi\"/></actuator></mujoco>");
  const auto model = Model::load(file);
  ASSERT_FALSE(model);
  EXPECT_EQ(model.error().what, file.string() +
                                    ":8: <motor>: there is no joint, tendon, site or body \"hpi\" "
                                    "to drive (did you mean \"hip\"?)");
}

}  // namespace
}  // namespace mjarm
