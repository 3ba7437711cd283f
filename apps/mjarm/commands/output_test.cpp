// Where answers go, for every command that writes a file: what stood there before, folders that are
// missing or in the way, equal runs, and Ctrl-C.
#include <gmock/gmock.h>

#include <filesystem>

#include "apps/mjarm/commands/crane_test.hpp"
#include "apps/mjarm/commands/program_test.hpp"
#include "mjarm/core/long_result.hpp"

namespace mjarm::app {
namespace {

using ::testing::HasSubstr;
namespace fs = std::filesystem;

/// A command that writes one file, without its `--out`, and the ending of that file.
struct Writer {
  std::vector<std::string> words;
  std::string ending;
};

class Outputs : public ::testing::Test {
 protected:
  [[nodiscard]] std::vector<Writer> writers() const {
    return {{{"fk", "--robot", robot_, "--q", "0,0,0"}, ".jsonl"},
            {{"ik", "--robot", robot_, "--pos", "0.3,0.2,0.3", "--task", "position", "--no-timing"},
             ".jsonl"},
            {{"path", "--robot", "ur5e", "--from", "0.3,-0.4,0.4", "--to", "0.2,-0.4,0.4", "--quat",
              "0,1,0,0", "--no-timing"},
             ".jsonl"},
            {{"time", "--problem", "p2p", "--robot", robot_, "--points", "0,0,0;1,1,10cm",
              "--no-timing", "--dt", "0.1"},
             ".json"},
            {{"plan", "--robot", robot_, "--goal", "1,-1,0.1", "--no-timing"}, ".json"},
            {{"model", "export", robot_}, ".urdf"},
            {{"workspace", "--robot", robot_, "--step", "150mm", "--slice", "z=0.3"}, ".csv"},
            {{"export", "point", "--to", "urscript"}, ".script"}};
  }
  support::ProgramResult write(const Writer& writer, const std::string& out) {
    std::vector<std::string> words = writer.words;
    words.insert(words.end(), {"--out", out});
    return mjarm(words, {.folder = folder_.path(), .input = {}, .environment = {}});
  }
  /// Names of what lies in the folder of the test.
  [[nodiscard]] std::vector<std::string> names() const {
    std::vector<std::string> out;
    for (const auto& entry : fs::recursive_directory_iterator(folder_.path())) {
      out.push_back(entry.path().lexically_relative(folder_.path()).string());
    }
    std::ranges::sort(out);
    return out;
  }

  support::TempFolder folder_;
  std::string robot_ = folder_.write("crane.xml", kCrane).string();
};

TEST_F(Outputs, WhatTookOverAMinuteIsNotReplacedUnasked) {
  const std::string old = folder_.write("probe", "kept").string();
  note_work(old, 81);
  if (LongResult::begin(old, {})) GTEST_SKIP() << "the file system keeps no notes";
  std::vector<Writer> all = writers();
  all.push_back({{"render", "hello"}, ".png"});
  for (Writer writer : all) {
    SCOPED_TRACE(writer.words.front());
    const std::string out = folder_.write("out" + writer.ending, "kept").string();
    note_work(out, 81);
    const auto refused = write(writer, out);
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_EQ(only_line(refused),
              out + ": took 81 s to make: replace it with --overwrite, or take another --out");
    EXPECT_EQ(folder_.read("out" + writer.ending), "kept");
    if (writer.words.front() == "render") continue;
    writer.words.emplace_back("--overwrite");
    EXPECT_EQ(write(writer, out).exit_code, 0);
    EXPECT_NE(folder_.read("out" + writer.ending), "kept");
    writer.words.pop_back();
    EXPECT_EQ(write(writer, out).exit_code, 0) << "the new one was quick";
  }
}

TEST_F(Outputs, NorAreFolders) {
  const fs::path out = folder_.path() / "run";
  fs::create_directory(out);
  note_work(out, 81);
  folder_.write("run/report.json", "kept");
  if (LongResult::begin(out, {})) GTEST_SKIP() << "the file system keeps no notes";
  const std::string policy = model_file("policies/reach.safetensors");
  for (const std::vector<std::string>& words :
       std::vector<std::vector<std::string>>{{"run", "point", "--headless"},
                                             {"demo", "point", "--headless"},
                                             {"demo", "car", "--headless"},
                                             {"eval", policy},
                                             {"train", "reach"}}) {
    const auto refused = write({words, ""}, out.string());
    EXPECT_EQ(refused.exit_code, 2) << words[0];
    EXPECT_THAT(only_line(refused), HasSubstr("run: took 81 s to make")) << words[0];
    EXPECT_EQ(folder_.read("run/report.json"), "kept") << words[0];
  }
  EXPECT_EQ(write({{"run", "point", "--headless", "--overwrite"}, ""}, out.string()).exit_code, 0);
  EXPECT_NE(folder_.read("run/report.json"), "kept");
  EXPECT_TRUE(LongResult::begin(out, {})) << "the new one was quick";
}

TEST_F(Outputs, ASecondRunWritesTheSameBytesInPlaceOfTheFirst) {
  for (const Writer& writer : writers()) {
    SCOPED_TRACE(writer.words.front());
    const std::string name = "out" + writer.ending;
    folder_.write(name, std::string(100000, 'x'));  // longer than what comes
    std::string first;
    for (int i = 0; i < 2; ++i) {
      const auto result = write(writer, name);
      ASSERT_EQ(result.exit_code, 0) << result.err;
      if (i == 0) first = folder_.read(name);
    }
    EXPECT_FALSE(first.empty());
    EXPECT_EQ(first.find("xxxx"), std::string::npos);
    EXPECT_EQ(folder_.read(name), first);
    fs::remove(folder_.path() / name);
    EXPECT_EQ(names(), std::vector<std::string>{"crane.xml"});
  }
}

TEST_F(Outputs, FoldersThatAreMissingOrInTheWayAreOneLineAndLeaveNothing) {
  fs::create_directory(folder_.path() / "taken");
  for (const Writer& writer : writers()) {
    SCOPED_TRACE(writer.words.front());
    const auto missing = write(writer, "no/such/out" + writer.ending);
    EXPECT_EQ(missing.exit_code, 1);
    EXPECT_THAT(missing.err, HasSubstr("no/such/out" + writer.ending + ": cannot be written"));
    const std::string taken = "taken/out" + writer.ending;
    fs::create_directory(folder_.path() / taken);
    const auto folder = write(writer, taken);
    EXPECT_NE(folder.exit_code, 0);
    EXPECT_THAT(folder.err, HasSubstr(taken));
    EXPECT_EQ(support::lines_of(folder.err).size(), 1U) << folder.err;
    EXPECT_EQ(folder.out, "");
    EXPECT_TRUE(fs::is_empty(folder_.path() / taken));
    fs::remove(folder_.path() / taken);
  }
  EXPECT_EQ(names(), (std::vector<std::string>{"crane.xml", "taken"}));
}

TEST_F(Outputs, BadInputLeavesTheOldAnswersAlone) {
  folder_.write("bad.jsonl", "{\"q\":[0,0,0],\"pos\":[0,0,0],\"quat\":[1,0,0,0]}\nbad\n");
  folder_.write("old", "old answers");
  const std::vector<std::string> before = names();
  const std::vector<std::vector<std::string>> commands = {
      {"fk", "--robot", robot_, "--in", "bad.jsonl"},
      {"ik", "--robot", robot_, "--in", "bad.jsonl", "--threads", "3"},
      {"path", "--robot", robot_, "--in", "bad.jsonl"},
      {"time", "--problem", "path_va", "--in", "bad.jsonl"},
      {"plan", "--in", "bad.jsonl"},
      {"plan", "--robot", robot_, "--goal", "0,0,90deg"},
      {"model", "export", "bad.jsonl", "--to", "urdf"},
      {"export", "bad.jsonl", "--to", "urscript"}};
  for (std::vector<std::string> words : commands) {
    SCOPED_TRACE(::testing::PrintToString(words));
    words.insert(words.end(), {"--out", "old"});
    const auto result = mjarm(words, {.folder = folder_.path(), .input = {}, .environment = {}});
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_FALSE(only_line(result).empty());
    EXPECT_EQ(result.out, "");
    EXPECT_EQ(folder_.read("old"), "old answers");
    EXPECT_EQ(names(), before);
  }
}

TEST_F(Outputs, NoAnswerIsAnAnswerToo) {
  // What cannot be done is exit code 1, and the file says so.
  const std::pair<Writer, const char*> cases[] = {
      {{{"ik", "--robot", robot_, "--pos", "3,0,0", "--task", "position"}, ""}, "\"ok\":false"},
      {{{"path", "--robot", "ur5e", "--from", "0.3,-0.4,0.4", "--to", "3,-0.4,0.4", "--quat",
         "0,1,0,0"},
        ""},
       "\"ok\":false"},
      {{{"plan", "--robot", robot_, "--goal", "0,0,9m"}, ""}, "\"ok\":false"}};
  for (const auto& [writer, says] : cases) {
    const auto result = write(writer, "answer.json");
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_FALSE(only_line(result).empty());
    EXPECT_THAT(folder_.read("answer.json"), HasSubstr(says));
    fs::remove(folder_.path() / "answer.json");
  }
}

/// Runs a shell script in the folder of the test, with `$mjarm` and `$robot`. `end` sends a signal
/// to the last program in the background and leaves its exit code.
support::ProgramResult disturb(const support::TempFolder& folder, const std::string& robot,
                               const std::string& script) {
  const std::string begin = "mjarm='" MJARM_PROGRAM "'; robot='" + robot +
                            "'; end() { pid=$!; kill -$1 $pid; wait $pid; };";
  return support::run_program("/bin/sh", {"-c", begin + script},
                              {.folder = folder.path(), .input = {}, .environment = {}});
}

TEST_F(Outputs, AStreamThatIsStoppedHasGivenEveryAnswerSoFar) {
  for (const char* const signal : {"INT", "TERM"}) {
    const auto result =
        disturb(folder_, robot_,
                "rm -f pipe out; mkfifo pipe; exec 3<>pipe; echo '{\"q\":[0,0,0]}' >&3;"
                "\"$mjarm\" fk --robot \"$robot\" --in - <pipe >out &"
                "while [ ! -s out ]; do sleep 0.02; done; end " +
                    std::string(signal));
    EXPECT_EQ(result.exit_code, 1) << signal;
    EXPECT_THAT(only_line(result), HasSubstr("stopped by the user"));
    EXPECT_EQ(json_lines(folder_.read("out")).size(), 1U);
  }
}

TEST_F(Outputs, AFileThatIsStoppedIsNeverThere) {
  // The temporary file tells that it has begun.
  std::string lines;
  for (int i = 0; i < 100000; ++i) lines += "{\"pos\":[0.3,0.2,0.3],\"quat\":[0,1,0,0]}\n";
  folder_.write("poses.jsonl", lines);
  for (const char* const signal : {"INT", "TERM"}) {
    const auto result = disturb(folder_, robot_,
                                "mkdir -p out; \"$mjarm\" ik --robot ur5e --in poses.jsonl "
                                "--out out/sol.jsonl --threads 2 &"
                                "while [ -z \"$(ls out)\" ]; do sleep 0.02; done; end " +
                                    std::string(signal));
    EXPECT_EQ(result.exit_code, 1) << signal;
    EXPECT_THAT(only_line(result), HasSubstr("stopped by the user"));
    EXPECT_TRUE(fs::is_empty(folder_.path() / "out"));
  }
}

/// A bar that turns about its end, between two posts: no way leads from one side of them to the
/// other, and a search goes on as long as it may.
constexpr const char* kCaged = R"(<mujoco><compiler angle="radian"/><worldbody><body>
<joint name="turn" axis="0 0 1" range="-2.5 2.5"/><geom type="capsule" fromto=".1 0 0 .9 0 0" size=".03"/>
<body pos="1 0 0"><joint name="roll" axis="1 0 0" range="-3 3"/><geom type="box" size=".02 .05 .02"/>
<site name="tip" pos=".1 0 0"/></body></body><geom type="box" pos=".5 .5 0" size=".1 .1 .2"/>
<geom type="box" pos=".5 -.5 0" size=".1 .1 .2"/></worldbody><actuator><position joint="turn"/>
<position joint="roll"/></actuator></mujoco>)";
constexpr const char* kCagedProblem =
    R"({"robot":{"name":"bar","base":"base","joints":[{"name":"turn",
"type":"revolute","parent":"base","child":"bar","xyz":[0,0,0],"quat":[1,0,0,0],"axis":[0,0,1],
"limits":[-2.5,2.5]},{"name":"roll","type":"revolute","parent":"bar","child":"end","xyz":[1,0,0],
"quat":[1,0,0,0],"axis":[1,0,0],"limits":[-3,3]}],"spheres":[{"link":"end","center":[0,0,0],
"radius":0.1}],"self_collision_link_pairs":[]},"problems":[{"id":"p","start":[1.6,0],"goals":[[0,0]],
"obstacles":[{"type":"sphere","pos":[0.7,0.7,0],"radius":0.2},{"type":"sphere","pos":[0.7,-0.7,0],
"radius":0.2}]}]})";

TEST_F(Outputs, ASearchThatIsStoppedEndsAtOnceAndLeavesNothing) {
  folder_.write("caged.xml", kCaged);
  folder_.write("caged.json", kCagedProblem);
  for (const char* const problem :
       {"--robot caged.xml --start 1.6rad,0 --goal 0,0", "--in caged.json"}) {
    for (const char* const signal : {"INT", "TERM"}) {
      // The temporary file tells that it has begun; a search of so many samples takes minutes.
      const auto result = disturb(
          folder_, robot_,
          "mkdir -p out; \"$mjarm\" plan --samples 10000000 --out out/path.json " +
              std::string(problem) +
              " & while [ -z \"$(ls out)\" ]; do sleep 0.02; done; sleep 0.3; end " + signal);
      EXPECT_EQ(result.exit_code, 1) << problem << result.err;
      EXPECT_EQ(only_line(result), "stopped by the user") << problem;
      EXPECT_LT(result.cpu_seconds, 30) << problem;
      EXPECT_TRUE(fs::is_empty(folder_.path() / "out")) << problem;
    }
  }
}

TEST_F(Outputs, AReaderThatHangsUpEndsTheProgram) {
  // As in `mjarm fk --in q.jsonl | head -1`: no endless work for nobody.
  std::string lines;
  for (int i = 0; i < 20000; ++i) lines += "{\"q\":[0,0,0]}\n";
  folder_.write("q.jsonl", lines);
  const auto result = disturb(folder_, robot_,
                              "{ \"$mjarm\" fk --robot \"$robot\" --in q.jsonl; echo $? >code; } | "
                              "head -1");
  EXPECT_EQ(support::lines_of(result.out).size(), 1U);
  EXPECT_NE(folder_.read("code"), "0\n");
}

}  // namespace
}  // namespace mjarm::app
