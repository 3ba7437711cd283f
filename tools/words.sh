# Part of ./dev: what it says to those who run mjarm for the first time, in English and in Chinese. Sourced, never run.
# What only developers meet, such as the checks of `./dev test`, is said in English alone.

# The language of messages, as mjarm chooses it: that of the first locale that is set, unless --lang names one.
language=${LC_ALL:-${LC_MESSAGES:-${LANG:-}}}
case " $* " in
  *" --lang zh"* | *" --lang=zh"*) language=zh ;;
  *" --lang en"* | *" --lang=en"*) language=en ;;
esac

declare -A sentences

# sentence NAME ENGLISH CHINESE: each %s stands for a value.
sentence() {
  sentences[$1]=$2
  if [[ $language == zh* ]]; then sentences[$1]=$3; fi
}

# words NAME [VALUE...]: prints that sentence.
words() {
  local name=$1
  shift
  # shellcheck disable=SC2059
  printf "${sentences[$name]}" "$@"
}

# Of any work
sentence begins "%s ..." "%s……"
sentence finished "%s: done in %s s" "%s：完成，用时 %s s"
sentence waiting "waiting for another ./dev in this folder" "正在等待此文件夹中的另一个 ./dev"
sentence read_only "%s cannot be written: clone mjarm into a folder of your own, or have its owner run ./dev there" \
  "无法写入 %s：请把 mjarm 克隆到自己的文件夹，或请其所有者在那里运行 ./dev"
sentence other_system "./dev runs on Linux, not on %s; on Windows use the zip (docs/windows.md), or WSL2, which is a Linux" \
  "./dev 只能在 Linux 上运行，不支持 %s；Windows 上请用 zip（docs/windows.zh-CN.md）或 WSL2（它就是 Linux）"
sentence other_machine "no files for machines of type %s: x86_64 and aarch64 are supported" \
  "没有适用于 %s 机器的文件：支持 x86_64 和 aarch64"

# Packages of the system
sentence missing "missing system packages: %s" "缺少系统软件包：%s"
sentence install_line "install them with: %s" "请这样安装：%s"
sentence needs_root "installing packages needs root: run ./dev as a user whom sudo lets in, or have an administrator run: %s" \
  "安装软件包需要 root 权限：请以可使用 sudo 的用户运行 ./dev，或请管理员运行：%s"
sentence apt_update "Package lists: apt-get update" "软件包列表：apt-get update"
sentence no_update "apt-get update failed, as above: is the network there?" "apt-get update 失败（见上文）：网络是否可用？"
sentence apt_install "System packages: installing %s (%s MB to fetch)" "系统软件包：正在安装 %s 个（需下载 %s MB）"
sentence apt_again "System packages: second try" "系统软件包：再试一次"
sentence no_install "apt-get could not install, as above: %s" "apt-get 未能安装（见上文）：%s"
sentence no_dpkg "this is neither Debian nor Ubuntu, so nothing is installed; needed are, by their names there: %s" \
  "此系统既不是 Debian 也不是 Ubuntu，因此不安装软件包；所需的软件包（按 Debian 的名称）：%s"
sentence no_program "%s is missing: install it and the packages named above" "缺少 %s：请安装它以及上面列出的软件包"
sentence nothing_missing "nothing is missing that mjarm needs; for the tests: ./dev --no-install test" \
  "mjarm 所需的软件齐备；测试所需的请看 ./dev --no-install test"

# What is fetched
sentence fetching "%s: downloading" "%s：正在下载"
sentence not_fetched "%s is missing; ./dev without --no-install fetches it" "缺少 %s；不带 --no-install 运行 ./dev 即可获取"
sentence no_pip "no python3 with pip: install python3-pip" "没有带 pip 的 python3：请安装 python3-pip"
sentence no_download "could not download %s: is the package index reachable?" "无法下载 %s：软件包索引能否访问？"
sentence other_file "%s: the downloaded file is not the expected one (its SHA-256 differs)" "%s：下载的文件不符（SHA-256 不同）"
sentence not_unpacked "%s: cannot unpack the wheel" "%s：无法解开 wheel"

# Building
sentence configuring "Configuring %s" "正在配置 %s"
sentence not_configured "cmake could not configure the preset %s" "cmake 无法配置预设 %s"
sentence building "Building %s" "正在编译 %s"
sentence not_built "the build of the preset %s failed" "预设 %s 编译失败"
sentence page "Page: building" "网页：正在构建"
sentence page_kinematics "Kinematics of the page: compiling" "网页的运动学：正在编译"
sentence no_page "the page of 'mjarm serve' is not built; ./dev page builds it" "“mjarm serve”的网页尚未构建；用 ./dev page 构建"
sentence without_page "mjarm runs without its page" "mjarm 在没有网页的情况下运行"
sentence no_page_kinematics "page: in files of --html runs play, but the tool cannot be dragged; all else works (%s)" \
  "网页：--html 写出的文件可以播放，但不能拖动工具；其余一切正常（%s）"
sentence no_emscripten "that needs emscripten, 850 MB: apt-get install --no-install-recommends emscripten, then ./dev page" \
  "需要 emscripten，占 850 MB：apt-get install --no-install-recommends emscripten，然后 ./dev page"
sentence no_headers "that needs the headers of Eigen, expected and fmt in /usr/include" \
  "需要 /usr/include 中有 Eigen、expected 和 fmt 的头文件"

usage_in_chinese() {
  cat <<'END'
用法：./dev [--no-install] 命令

  ./dev demo ellipse     安装缺少的软件并编译，然后运行 `mjarm demo ellipse`
  ./dev doctor           装了什么，缺什么、怎么装
  ./dev 参数...          mjarm 的其他命令同样如此：./dev --help 列出全部命令

  ./dev test             全部检查与测试；最后一行给出计数
  ./dev long [SECONDS]   随机测试，用例最多增至一百倍；并对文件做变异，每个解析器这么多秒（600）
  ./dev wheel            Python 软件包，写入 dist/ 并检验
  ./dev lerobot          LeRobot 的数据集与环境，由 LeRobot 自己检验（6 GB：torch）
  ./dev package          Debian 软件包和压缩包，写入 dist/，并在全新的系统里安装、使用、删除
  ./dev windows [--test] 适用于 Windows 的 zip，写入 dist/，在本机编译；--test 在 Wine 下试用
  ./dev page             `mjarm serve` 的网页（需要 Node 18，没有则自动获取）；./dev serve 会自动构建
  ./dev docs             全部页面的网站，两种语言，写入 build/docs
  ./dev docs --run [PAGE...]    运行页面中的命令，并与页面所引用的输出比较
  ./dev build [PRESET]   按预设编译全部：dev（默认）、release、asan、tsan……
  ./dev check            只检查模块次序、格式和头文件能否单独编译
  ./dev format           把源码整理成本项目的格式
  ./dev tidy [FILE...]   用 clang-tidy 检查源码
  ./dev asan|tsan        带 sanitizer 编译并测试
  ./dev coverage         测试运行到哪些行
  ./dev arms [ROBOT...]  获取公开的机器人：每台画一个正方形，Menagerie 的还做更多
  ./dev fuzz [SECONDS] [NAME]   对文件读取器做模糊测试，全部（各 600 s）或一个：load urdf program json……
  ./dev bench            微基准测试（带参数时：`mjarm bench 参数`）
  ./dev peers            `mjarm bench SUITE --peers .venv` 用来对比的库，装入 .venv
  ./dev peers near       `mjarm bench plan --set near --peers .venv-near` 所用的库，装入 .venv-near
  ./dev peers rl         `mjarm bench rl --peers .venv-rl` 所用的库，装入 .venv-rl（6 GB：torch）

--no-install 绝不改动机器：只报告缺少什么，退出码为 1。
可在任何文件夹里运行，路径相对于当前文件夹。已有 MuJoCo >= 4.0 时可用
MUJOCO_ROOT=文件夹 ./dev ... 指定。
END
}
