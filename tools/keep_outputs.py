#!/usr/bin/env python3
"""Keeps what mjarm answers, so that two builds can be compared byte by byte.

    tools/keep_outputs.py run --mjarm build/release/bin/mjarm --out before --jobs 2 --data cases
    ... change the sources, build ...
    tools/keep_outputs.py run --mjarm build/release/bin/mjarm --out after --jobs 2 --data cases
    tools/keep_outputs.py compare before after

`run` calls mjarm with a fixed list of command lines, each in an empty folder of its own, and keeps in OUT/NAME what it
printed, its exit code and, in `work`, every file. `--only REGEX` runs the lines it is found in. `--data FOLDER` adds
cases on public data: ik/, trajectory_cases/, motionbenchmaker/ and menagerie/ stand there.
`compare` prints a line for each file that differs; exit code 1 where there is one.
"""

import argparse
import concurrent.futures
import gzip
import itertools
import json
import os
import pathlib
import random
import re
import shutil
import signal
import subprocess
import sys
import time
import zlib

# Lines of sh, in which (a|b) stands for either, @1 for what the first of these gave and @name for one of ALIASES; a line that begins
# with a blank goes on with the one before. What FILES holds is there where a line names it. No answer may depend on the clock: this
# leaves out --time-budget, `bench plan --set anytime` and commands interrupted; `train` says its time unless --quiet keeps it still.
CASES = r"""
mjarm @lang (|demo|doctor|model|model info|model tree|model check|model export|models|models install|fk|ik|path|plan|verify|time|check|run|export|render|view
 |workspace|train|eval|learn|learn check|bench|bench ik|bench path|bench plan|bench time|bench control|bench pick|bench sim|bench rl) --help
(LANG=zh_CN.UTF-8|LC_ALL=zh_TW.UTF-8|LANG=de_DE.UTF-8|LANG=zh LC_ALL=C) mjarm (-h|nonsense|--lang=en nonsense|--lang|--lang zh-TV --help|--version)
mjarm @lang (docter|xyzzyxyzzy|''|model|model inof|model info|model tree ur5e panda|fk --robto ur5e|models|bench|bench ki|verify|path|time|workspace
 |fk --robot=ur5e --qq=1|fk --no-timing|fk --robot|fk --robot ur5e --robot panda|fk --robot ur5e|--vrebose doctor|plan|train|demo elipse|run|run elipse
 |fk --robot ur5e --q 1 --in x|check|export|render|view|eval|train raech|plan --robot ur5e --in x|--quiet fk --robot ur5e|--quiet --verbose doctor)
mjarm (--help|doctor --json|fk --robot ur5e --q @q0|fk --robot ur5e --in q.jsonl|ik --robot ur5e @down) >/dev/full
mjarm @lang doctor @json
(MUJOCO_GL=egl|MUJOCO_GL=osmesa|MUJOCO_GL=none|DISPLAY=:7) mjarm (doctor|render ur5e --out a.png @px)
mjarm=$(command -v mjarm); PATH=/nowhere "$mjarm" (doctor|render ur5e --out a.mp4)
mjarm @lang model (info|tree|check) (ur5e|panda|car|hello|small.xml|slide.xml|rail.urdf|mesh.xml|@models) @json
mjarm @lang model info (ur5e --tip ee_link|ur5e --tip attachment_sit|panda --tip hand|ur5f|.|q.jsonl|nowhere/r.xml|universal_robots_ur5e/ur5f.xml)
printf '<mujoco>%s</mujoco>' '(|<worldbody><body>|<worldbody><geom size="nan"/></worldbody>|<worldbdy/>|<include file="bad.xml"/>|<option timestep="1e999"/>
 |<worldbody><joint/></worldbody>|<include file="../a.xml"/>|<asset><mesh file="none.obj"/></asset>|<asset><mesh file="/etc/passwd"/></asset>
 |<worldbody><body name="a"/><body name="a"/></worldbody>|<actuator><motor/></actuator>)' >bad.xml; mjarm @lang model (info|check --json) bad.xml
(many 0 x|printf '\376\377\000<'|printf '<mujoco/>\000'|many 99999 ' '|many 9999 '<a>'|printf '<mujoco model="\374"/>') >bad.xml; mjarm model info bad.xml
sed 's/(kp="300"/kp="3"|kv="20"/kv="0"|range="-170 170"/range="-3.1 3.1"|euler="0 0 90"/euler="0 0 1.5708"|-50 50/-1 1|"home"/"rest"|<geom/<geom mass="99"
 |<site.*15"\/>//|<option/<option timestep="0.05" gravity="0 -9.81 0"|qpos="0 0.4/qpos="0 3|ctrl="0 0.4 0.8"//|joint="lift"/joint="turn"|size="0.02"/size="20"
 |ctrlrange="-2.1/ctrlrange="-1|<geom/<geom contype="0"|qpos="0 0.4 0.8/qpos="0 2 2|<body name="one"/<body name="more"><inertial pos="0 0 1" mass="1"
 diaginertia="1 1 9"\/><\/body><body name="one")/' small.xml >bad.xml; mjarm @lang model check bad.xml @json
mkdir inner; printf '<mujoco><include file="../small.xml"/></mujoco>' >inner/a.xml; mjarm model (info|check) inner/a.xml (|--allow-outside)
sed 's/cube.obj/package:\/\/p\/cube.obj/' rail.urdf >a.urdf; mkdir -p b/p; mv cube.obj b/p; mjarm model (info|check) a.urdf (|--package-path b|--package-path c)
mjarm @lang model check (ur5e --against universal_robots_ur5e/ur5e.urdf|panda --against franka_emika_panda/panda.urdf|ur5e --against car|panda --tip hand
 |franka_emika_panda/panda_nohand.xml --against franka_emika_panda/panda.urdf|ur5e --against panda|ur5e --against ur5e|ur5e --tip nose
 |small.xml --against slide.xml|ur5e --against nowhere.xml) @json
sed 's/(name="bend"/name="bend" ref="10"|"lift" axis="0 1 0"/"lift" axis="0 -1 0"|name="two" pos="0 0/name="two" pos="0 0.01|turn/rotate|0.25/0.24
 |euler="0 0 90"/euler="0 90 0"|"tcp" pos="0/"tcp" pos="0.1)/g' small.xml >a.xml; mjarm @lang model check small.xml --against a.xml @json
mjarm model export (ur5e|panda|car|small.xml|slide.xml|mesh.xml|@wall) --out a.(xml|urdf|mjb) && mjarm model check a.*; mjarm model info a.* --json
mjarm model export rail.urdf --out a.(xml|urdf) && mjarm model check a.*; mjarm model info a.* --json
mjarm @lang model export (ur5e|ur5e --out a.txt|ur5e --to stl --out a|ur5e --to mjcf --out a.urdf|small.xml --out small.xml|ur5e --out nowhere/a.xml)
mjarm @lang models install (--list|--list --json|--remove|--list --remove|--list --from .|ur5|ur5e panda|--from nowhere|--from .|panda --from file:///nowhere)
env -u HOME -u XDG_DATA_HOME mjarm models install --list
mjarm fk --robot (ur5e --q @q0|ur5e --q 0,0,0,0,0,0 --tip ee_link|ur5e --q -.5,1,-.25,0,1e-3,-6.28|panda --q @q7|small.xml --q 1,1,1|ur5e --in q.jsonl
 |panda --q @q7 --tip hand|universal_robots_ur5e/ur5e.urdf --q @q0|franka_emika_panda/panda.urdf --q @q7|rail.urdf --q 10mm,20deg|ur5e --in /dev/null
 |mesh.xml --q 1,1,1 --out x.json|ur5e --in q.jsonl --out x.jsonl|ur5e --q @q0 --quiet|ur5e --q @q0 -v)
mjarm @lang fk --robot (ur5e --q 1,2|ur5e --q a,0,0,0,0,0|ur5e --q nan,0,0,0,0,0|ur5e --q 1e999,0,0,0,0,0|ur5e --q 1mm,0,0,0,0,0|ur5e --q ,,,,,|ur5f --q @q0
 |car --q 0|ur5e --q @q0 --tip nose|ur5e --q @q0 --out nowhere/x|ur5e --in nowhere.jsonl|universal_robots_ur5e --q @q0|ur5e --in .)
printf '%s\n' '@line' '(no json|{"q":[1e999,0,0,0,0,0],"pos":[0,0,NaN]}|{"q":[1],"pos":[1],"type":"arc","from":{}}|{"q":[0|null|{"q":["x",0,0,0,0,0],"type":7}
 |{"Q":[1],"Pos":0,"type":"lin"}|{"pos":[0,0,1],"quat":[1,1,0,0],"type":"poses","poses":[]}
 |{"pos":[0,0,1],"quat":[1,0,0,0],"seed":[1],"type":"polyline","points":[1]})' '@line' >a.jsonl; mjarm @lang (fk|ik @nt|path @nt) --robot ur5e --in - <a.jsonl
(many 9999 [|printf '\377\376{}'|printf '{"q":"\355\240\200"}'|many 999 '{"a":'|head -c 3000000 /dev/zero) >a.jsonl; mjarm fk --robot ur5e --in a.jsonl
mjarm ik @nt --robot (ur5e @down|ur5e --pos 0.3,0.4,0.2 --quat 0.5,0.5,-0.5,0.5 --seed-q @q0|panda --pos 0.4,0,50cm --quat 0,1,0,0|ur5e --pos 0,0,3 @dn
 |panda --tip hand --pos 0.4,0,0.5 @dn|ur5e --pos 0,0.05,0.5 @dn|rail.urdf --pos 0.4,0.1,0.2 --euler 0,0,0.5) (|--all|--all --windings|--windings --seed 7)
mjarm ik @nt --robot (ur5e|panda|small.xml|slide.xml) --pos 0.2,0.1,0.4 --task (position|axis --euler 3,0.2,0|position --all)
mjarm ik @nt --robot panda --pos 0.4,0.1,0.5 @dn --prefer (posture|middle|manipulability) --task (pose|axis)
mjarm ik @nt --robot ur5e --in poses.jsonl --task (pose|position|axis) (|--all|--all --windings) --threads (1|3)
mjarm ik @nt --robot panda --in poses.jsonl (|--all|--prefer middle|--seed 9 --out x.jsonl|--prefer manipulability --threads 2)
sed 's/}$/, "seed": [1, -1, 1, -1, 1, -1]}/' poses.jsonl | mjarm ik @nt --robot ur5e --in - --quiet
mjarm @lang ik @nt --robot (ur5e --pos 0,0,1|ur5e @down --quat 1,0,0,0|ur5e --pos 0,0 @dn|ur5e --pos 0,0,1 --euler 0,0|ur5e --pos 0,0,1 --quat 1,1,0,0
 |ur5e --pos 0,0,1deg @dn|ur5e @down --task poze|ur5e @down --prefer midle|car @down|ur5e @down --prefer middle --all|ur5e @down --seed x|ur5e @down --in x
 |ur5e @down --threads 0|ur5e @down --threads 9999|ur5e @down --seed-q 1|ur5e --pos nan,0,0 @dn|ur5e --pos 1e9,0,0 @dn)
mjarm path @nt --robot ur5e --from 0.3,-0.4,0.4 --to -0.3,-0.4,0.4 (@dn|--quat 0,1,0,0 --via 0,-0.5,0.4) (|--collisions|--partial|--start @q0
 |--start @q0 --keep-start|--max-step 0.1|--orientation-tol 20deg|--out x.json)
mjarm path @nt --robot (ur5e|panda) --in paths.jsonl (|--collisions|--partial --max-step 5deg|--orientation-tol 0.3 --out x.jsonl)
mjarm path @nt --robot (ur5e|panda|small.xml|@wall) --from 0.4,-0.4,0.2 --to (0.4,0.9,0.3|-0.4,-0.4,0.2) @dn (|--partial --collisions)
mjarm path @nt --robot panda --tip hand --request '{"type":"ellipse","center":[0.5,0,0.4],"a":0.1,"b":0.05,"normal":[0,0,1],"quat":[0,1,0,0],"points":50}'
mjarm @lang path --robot ur5e (--from 0,0,1|--from 0,0,1 --to 0,0,1 @dn|--from 0,0,1 --to 0,1,1|--request '{"type":"lin"}'|--request 1|@up --max-step 0
 |--from 0,0,1 --request '{}'|--in x --from 0,0,1|@up --orientation-tol 90deg|@up --via 0,0.5,1|@up --start 1)
mjarm plan @nt --in (crane.json|crane.json.gz --threads 2) (|--seed 4|--planner rrtstar --samples 300|--samples 1|--out p.json)
mjarm plan @nt --in crane.json --samples 400 --planner ompl(|:RRTConnect|:RRT|:LazyRRT|:EST|:BiEST|:FMT|:RRTstar|:RRTsharp|:InformedRRTstar|:BITstar|:ABITstar)
mjarm @lang plan @nt --in crane.json (--problem plate/1|--problem plat/1|--planner rrt|--samples 0|--seed -1|--threads 0|--time-budget 0|--spheres 1mm
 |--time-budget 2h|--picture a.png|--picture a.txt --problem plate/1|--view --picture a.png|--problem plate/1 --view|--out nowhere/p.json)
mjarm plan @nt --in crane.json --problem pillar/0 --picture p.(png|gif|mp4) @px (|--quality low --camera 30deg,-40deg,3)
sed 's/("robot"/"robt"|"revolute"/"ball"|"base"/"bse"|"hand"/"hnd"|"radius": 0.02/"radius": -1|"xyz": \[0/"xyz": \[NaN|-3, 3/3, -3|$/ x|"quat": \[1/"quat": \[2
 |"axis": \[0, 0, 1\]/"axis": \[0, 0, 0\]|"plate\/1"/"open\/1"|"cylinder"/"cone"|"capsule"/"ball"|"goals"/"goal"|-1, 0/0|"open\/1"/3|5, 5\], \[1, 0/7, 7
 |"problems": \[/"problems": \[1,|"start": \[-1/"start": \[3|"start": \[-1/"start": \[0|\[\[5, 5\], \[1, 0\]\]/\[\]|"child": "hand"/"child": "carriage"
 |"length": 1/"length": -1)/g' crane.json >bad.json; mjarm @lang plan @nt --in bad.json
head -c 200 crane.json.gz >cut.gz; mjarm plan --in (cut.gz|.|nowhere.json|q.jsonl)
mjarm plan @nt --in crane.json --out p.json (|--planner ompl); mjarm verify p.json --in crane.json (|--json|--step 1mrad --threads 2)
mjarm @lang verify crane_paths.json --in crane.json @json (|--step 0.3|--cylinders as-given|--tol 30mm|--threads 3)
mjarm @lang verify (nowhere.json|crane_paths.json --tol -1|crane_paths.json --step 0|crane_paths.json --cylinders x|q.jsonl|crane_paths.json --robot ur5e
 |crane_paths.json --hold x|crane_paths.json --threads 0) --in crane.json
printf '{"open/0":%s}' '(1|{}|{"path":3}|{"ok":1}|{"path":[],"cost":"x"}|{"path":[[0,0]]}|{"path":[[0,0]],"hold":1}
 |{"path":[[0,0]],"tilt":{"limit":2,"largest":0,"tool":[0,0,1],"world":[0,0,1]}}|{"path":[[0,0]],"spheres":1e-9})' >p.json; mjarm @lang verify p.json --in
 crane.json
printf '{"a":[[@before],[@behind]]}' >p.json; mjarm verify p.json --robot (ur5e|@wall) @json
mjarm plan @nt --robot @wall --out p.json (@way|@way --keep-upright 5deg|@there|@far --within 400mm,0,0 --turn 180deg|@way --spheres 5mm
 |@there --lean 10deg --turn 3.14 --seed 3|--pos -0.3,-0.45,0.2 --task position|@way --planner rrtstar --samples 300|@way --planner ompl --allow wall,floor
 |@there --keep-upright 10deg --start @before --task axis) && mjarm verify p.json --robot @wall --json
mjarm plan @nt --robot panda --pos 0.4,-0.3,0.4 (--task position|--task axis @dn|--quat 0,1,0,0 --tip hand) --out p.json && mjarm verify p.json --robot panda
mjarm @lang plan @nt --robot @wall (--pos 0,-0.45,0.2 @dn|@far|--goal 1,2|--pos 1,2,3|--goal @q0 --within 1,1,1|--pos 1,2,3 --task pos|--goal 0,9,0,0,0,0
 |--goal @q0 --problem x|--pos 1,2,3 --task position --within 0,0,-1|--goal @q0 --keep-upright 90deg|--pos 1,2,3 --task position --lean 181deg
 |--goal @q0 --spheres 0|--start 0,0,0,0,0,0 --goal @q0|--goal 0,0,0,0,0,nan|--goal @q0 --hold wall|--goal @q0 --allow wall|--goal @q0 --allow wall,flor
 |--pos 1,2,3 --task position --keep-upright 5deg)
mjarm plan @nt --robot @wall @way --picture p.png @px --camera (overview|top|nose)
cp -r "$SHARE"/models/* .; mjarm plan @nt --allow-outside --robot rod.xml @way --out p.json (|--hold rod|--hold rod --allow rod,wall
 |--hold rood) && mjarm verify p.json --allow-outside --robot rod.xml
mjarm time @nt --problem (p2p|path_va|path_vaj|via_vaj) --in cases.json (|--check|--dt 0.05|--dt 50ms --check --out t.json)
mjarm time @nt --problem (p2p|path_va|path_vaj|via_vaj) --robot (ur5e --points "@q0;0,0,0,0,0,0"|panda --points "@q7;@p7") (|--check --dt 0.1)
mjarm time @nt --problem (path_va|path_vaj|p2p) --points "@q0;0,0,0,0,0,0;1,1,1,1,1,1" --check --torque (|0.5|0|2)
mjarm @lang time @nt --problem (path --points 0|p2p --points 0|p2p --points "@q0"|p2p --in cases.json --dt 0|p2p --in nowhere.json|p2p --in q.jsonl
 |p2p --points "@q0;@q0" --in x|path_va --points "@q0;@q0"|p2p --points "@q0;0,0,0,0,0,0" --dt 1e-9|path_va --in cases.json --torque --robot small.xml)
sed 's/("limits"/"limit"|"v": \[3/"v": \[0|"v"/"V"|"id": 0/"id": 1|"id": 0/"id": 0.5|"cases": \[/"cases": \[7,|"q0": \[/"q0": \[1,|"q0"/"q"|"v0": \[/"v0": \[9
 |"waypoints": \[/"waypoints": \[1, )/' cases.json >bad.json; mjarm @lang time @nt --problem (p2p|path_va) --in bad.json
mjarm @lang check (@programs|all.yaml|small.yaml) @json
printf 'robot: ur5e\nprogram:\n- %s\n' '(|3|movx: {}|movej: {joint: [0]}|movej: {joints: [0, 0, 9, 0, 0, 0]}|movej: {joints: [1]}|movel: nowhere|wait: x
 |movel: {pos: [0, -0.5, 0.4]}|grip: open|movel: {pos: [0, -0.5, 0.4], euler: [180, 0, 0]}|movel: {pos: [0, -0.5, 0.4], quat: [1, 1, 0, 0]}|wait: -1
 |set: {tool: nose}|movel: {pos: [0.1, -1.45, 0.4], @turn}|movel: {pos: [0, -0.5, 0.4], quat: [0, 1, 0, 0], @turn}|movel: {pos: [0, -0.5, -0.2], @turn}
 |movel: {pos: [0, 10kg, 0.4], @turn}|movej: {joints: nowhere}|&a {wait: *b}|movel: {pos: [0, 0, 1], matrix: [[1, 0, 0], [0, 1, 0], [0, 0, 2]]}
 |movel: {pos: [0.3, -0.4, 0.4], @turn, speed: 50}|movej: {joints: home, speed: 2}|plan: {pos: [0, 0, 3], @turn}|movel: {pos: [0, 0, 1], @turn, frame: flor}
 |movec: {via: home, to: home}|repeat: {times: 99999, program: [wait: 1]}|text: {text: "?", pos: [0, -0.5, 0.4], @turn}|circle: {center: [0, -0.4, 0.4], normal:
 [0, 0, 1], radius: -1, @turn}|ellipse: {center: [0, -0.2, 0.5], normal: [0, 0, 1], a: 0.3, b: 0.15, @turn}|polyline: {points: [[0, 0, 1]], @turn}
 |plan: {joints: [0, 0, 0, 0, 0, 0]})' >bad.yaml; mjarm @lang (check|check --json|run @hl) bad.yaml
printf 'robot: (ur5e|ur5f\nprogram: []|ur5e\nrobot: ur5e|ur5e\nscene: x.xml\nprogram: []|[|ur5e\nspeed: fast\nprogram: []|ur5e\ncontrol: serv\nprogram: []
 |ur5e\nprogram: []\n---\na: b|ur5e\ncolour: 1|ur5e\nframes: {a: {pos: [0, 0, 0], @turn, frame: a}}\nframe: a\nprogram: [movel: {pos: [0, 0, 1], @turn}]
 |ur5e\nframe: wrist_3_link\nprogram: [movel: {pos: [0, 0, 0], @turn}]|ur5e\nstart: [0, 0, 3, 0, 0, 0]\nprogram: []|panda\nprogram: [wait: 1]
 |ur5e\nscene: @wall\nprogram:\n- plan: {pos: [0.3, -0.45, 0.2], @turn}\n- movel: {pos: [-0.3, -0.45, 0.2], @turn})\n' >bad.yaml; mjarm @lang (check
 |check --json|export --to urscript|view) bad.yaml
mjarm run (@programs|all.yaml|small.yaml) @hl
mjarm run movel @hl (--control servo|--control servo_gravity|--control feed_forward|--control joint_impedance|--control tool_impedance|--control servos
 |--tolerance 1um|--tolerance 10mm --quiet|--tolerance -1|-v)
trap '' XFSZ; ulimit -f (8|600); mjarm run movel @hl
mjarm @lang export (@programs|all.yaml|nowhere.yaml|small.yaml|movel --out a.script|small.yaml --out small.yaml) --to (urscript|urscritp)
mjarm @lang demo (|car @hl|ur5e @hl|ur5e_vision @hl|point @hl|movej @hl|movel @hl|ellipse @hl|letters @hl|singularity @hl|flip @hl|avoid @hl|square @hl
 |ellipse --meshes @hl|car --meshes @hl|ellipse --seconds 0 @hl|movel --tip nose @hl|avoid --robot panda @hl|ellipse --guide @hl)
mjarm demo (movel --guide|letters --guide|point --guide|movej --guide|movel --control servo|movel --control serv|reach|letters --text 9Z|letters --text a.b) @hl
mjarm demo (ellipse|car|singularity|flip|reach|ellipse --guide|square|movel --video) @hl --seconds 0.4
mjarm demo square @hl --robot (panda|small.xml|slide.xml|rail.urdf|mesh.xml|universal_robots_ur5e/ur5e.urdf|car|nowhere.urdf)
mjarm @lang render (ur5e|panda|car|small.xml|mesh.xml|table) --out a.png @px
mjarm render ur5e --out a.png @px (--quality low|--quality medium|--camera top|--camera 9deg,-20deg,2.5|--camera 9deg,-20deg,2500mm,0,0,0.4 --quality high)
mjarm render (panda|movel) --out a.(mp4|gif) @px --seconds 0.3 --fps 10
mjarm @lang render movel --out (a.bmp|a.png --size 0x5|a.png --camera nose|a.png --camera 1,2|a.png --quality best|a.png --seconds 0.1 @px|a.mp4 --fps 0|''
 |a.mp4 --size 95x63 --seconds 0.1|nowhere/a.png|a.png --fps 3|a.mp4 --seconds -1)
mjarm @lang view (ur5e|small.xml --passive|table|ur5e --size 12x|ur5e --quality best|ur5e --seconds -1|table --seconds 0|ur5e --camera nose|ur5e --tip nose)
xvfb-run -n $$ mjarm (view ur5e|view panda --paused|view car|view small.xml --passive --quality low|view table --camera front|plan @nt --in crane.json --problem
 pillar/0 --view) --seconds 0.5 --size 300x200
mjarm @lang workspace --robot ur5e --step 50mm (|--json|--slice x=-10cm|--euler 90deg,0,0|--quat 0,1,0,0|--tool-down|--position-only)
mjarm workspace --robot (ur5e|panda --tip hand|small.xml|slide.xml) --step 60mm (--slice y=0 --threads 3|--slice z=0.3|--out m.png|--out m.svg|--out m.csv)
mjarm @lang workspace --robot ur5e (--slice w=1|--slice z=1deg|--step 0|--step 1um|--out a.txt|--threads x|--threads 2000|--slice z=9|--euler 1
 |--tool-down --position-only|--step 60mm --out nowhere/a.csv)
mjarm @lang train reach --print-config (|--region wide|--guide|--orientation --obstacle --seed 5|--config train.yaml --steps 9)
mjarm --quiet train reach --config train.yaml @nt --out t (|--threads 2|--seeds 2|--seed 7|--region wide|--orientation --obstacle|--guide)
mjarm --quiet train reach --config train.yaml @nt --out t && mjarm --quiet train reach --resume t/last.safetensors --steps 1024 @nt (|--out u) && mjarm eval
 t/best.safetensors --episodes 5 @nt --out e
sed 's/(4}/4, stop_share: 0.9}|epochs/epoch|epochs: 2/epochs: 1.5|512/-1|actor: .../actor: 3|ppo: /ppo: 3 #|training/trainin|task: {/task: {region: wid, )/'
 train.yaml >a.yaml; mjarm @lang --quiet train reach --config a.yaml @nt --out t
mjarm @lang train reach (--config train.yaml --resume x|--resume nowhere.safetensors|--seeds 0|--config nowhere.yaml|--region wode|--resume q.jsonl)
mjarm eval ("$SHARE"/models/policies/reach.safetensors|sb3_tanh.zip|sb3_shared.zip|sb3_sde.zip|sb3_guide.zip) --episodes 9 @nt --out e (|--seed 5|--region wide
 |--threads 2|--orientation|--guide|--lang zh-CN)
head -c 9000 sb3_tanh.zip >a.zip; head -c 4000 "$SHARE"/models/policies/reach.safetensors >a.safetensors; mjarm @lang eval (nowhere.zip|q.jsonl|a.zip
 |a.safetensors|sb3_tanh.zip --task rech|sb3_tanh.zip --episodes 0)
mjarm bench (ik|path|time) --rounds 1 @nt (|--json|--robot small.xml|--robot slide.xml --json|--robot universal_robots_ur5e/ur5e.urdf --out a.md|--robot ur5f
 |--peers venv --json|--robot ur5e --peers x|--robot ur5e --data x|--rounds 0|--robot ur5e --lang zh-CN --peers venv)
mjarm @lang bench (control --poses 2|control --poses 0|control --poses 2 --robot car|sim --rounds 1 --steps 9|sim --steps 0|sim --robot ur5f) @nt @json
mjarm @lang bench plan @nt --data crane_set (|--json|--set panda|--set ur5 --seed 3|--set scaling --out b|--set anytime|--set pandas|--peer-every 0
 |--set panda --peers venv|--set panda --peers nowhere|--seed x)
mjarm bench rl @nt --out b (--seeds 1 --steps 256 --set tutorial|--seeds 1 --steps 256 --set wide --json|--seeds 1 --steps 256 --set as_model --peers venv
 |--set tutorail|--seeds 0|--steps x|--set tutorial --seeds 1 --steps 64 --peers nowhere)
mjarm ik @nt --robot ik_set/(ur5e|panda).urdf --in ik_set/@1_(reachable|unreachable).jsonl (|--all|--all --windings|--threads 2|--task axis)
mjarm ik @nt --robot ik_set/panda.urdf --in ik_set/panda_reachable.jsonl --prefer (posture|middle|manipulability)
mjarm path @nt --robot ik_set/ur5e.urdf --in ik_set/ur5e_(lines|ellipse|ellipse_far).jsonl (|--partial --orientation-tol 15deg)
mjarm time @nt --in time_set/(ur5e_paths|panda_paths|ur5e_ellipse).json --problem (path_va|path_vaj|via_vaj) (|--check)
mjarm time @nt --in time_set/(ur5e|panda)_p2p.json --problem p2p (|--dt 0.2|--check)
mjarm plan @nt --in mbm_set/mbm_(panda|ur5)_public.json.gz --out p.json (|--threads 2 --seed 5)
mjarm plan @nt --in mbm_set/mbm_(panda|ur5)_public.json.gz --problem @1/(bookshelf_small|bookshelf_tall|bookshelf_thin|box|cage|table_pick
 |table_under_pick)/0004 --out p.json --picture p.png @px (|--planner rrtstar --samples 2000|--planner ompl --samples 20000); mjarm verify p.json --in
 mbm_set/mbm_@1_public.json.gz --threads 2 --json
mjarm bench (ik --data ik_set|path --data ik_set|time --data time_set) @nt --rounds 1 --robot ur5e @json
mjarm bench plan @nt --data mbm_set --set (panda|ur5)
tar xf menagerie/(universal_robots_ur5e|franka_emika_panda).tar.xz; r=@1/scene.xml; mjarm model info $r; mjarm model tree $r; mjarm model check $r; mjarm model
 check $r --against ur5e; mjarm model check $r --against panda; mjarm render $r --out a.png @px; mjarm model export $r --out a.urdf; mjarm plan @nt --robot $r
 --pos 0.4,-0.3,0.4 --task position --out p.json; mjarm verify p.json --robot $r; rm -r @1
"""
ALIASES = {
    "lang": "(|--lang zh-CN)", "json": "(|--json)", "nt": "--no-timing", "hl": "--headless --no-timing --out o", "px": "--size 96x64",
    "q0": "0,-90deg,90deg,-90deg,-90deg,0", "q7": "0.1,-0.5,0.2,-2,0.3,1.6,-0.7", "p7": "0.9,0.1,-0.2,-1.5,0.6,2.1,0.4",
    "dn": "--euler 180deg,0,0", "turn": "euler: [180deg, 0, 0]", "up": "--from 0,0,1 --to 0,1,1 @dn", "down": "--pos -0.13,0.6,0.1 @dn",
    "far": "--pos -0.95,-0.3,0.2 @dn", "there": "--pos -0.3,-0.45,0.2 @dn", "way": "--start @before --goal @behind",
    "before": "-4.375,-1.2456,1.9905,-2.3157,-1.5708,0", "behind": "-5.551,-1.2456,1.9905,-2.3157,-1.5708,0",
    "wall": "universal_robots_ur5e/wall.xml", "pose": '"pos":[0.3,-0.4,0.4],"quat":[0,1,0,0]',
    "line": '{"q":[0,0,0,0,0,0],@pose,"type":"poses","poses":[{@pose}]}'}
DATA = {"ik_set": "ik", "time_set": "trajectory_cases", "mbm_set": "motionbenchmaker", "menagerie": "menagerie"}  # in --data
MANY = 'many() { yes "$2" | head -n "$1" | tr -d "\\n"; }\n'
SECONDS = 300  # until a case is ended; on a busy machine each takes many times as long as by itself


def rows(count, size, seed, half):
    """Lists of numbers that look random."""
    rng = random.Random(seed)
    return [[rng.uniform(-half, half) for _ in range(size)] for _ in range(count)]


def json_lines(objects):
    return "".join(json.dumps(entry) + "\n" for entry in objects)


NEAR = [{"pos": p, "quat": [0, 1, 0, 0]} for p in ([0.3, -0.4, 0.4], [0.3, -0.4, 0.2], [0.45, -0.2, 0.2], [0, 0.9, 0.6])]
BOX = {"name": "plate", "type": "box", "pos": [0.3, 0.5, 0.5], "quat": [1, 0, 0, 0], "half": [5e-5, 0.2, 0.2], "radius": 0.12, "length": 1}
POST = dict(BOX, name="pillar", type="cylinder", pos=[0, 0.67, 0.5], quat=[0.92387953, 0, 0, 0.38268343], vamp_as="box")
SCENES = {"open": [], "plate": [BOX], "pillar": [POST, dict(POST, name="post", radius=0.03, pos=[0.6, 0.6, 0.5], vamp_as="capsule"),
                                                 dict(POST, name="ball", type="sphere", radius=0.05, pos=[-0.6, 0.5, 0.6])]}
RAIL = dict(BOX, name="rail", type="prismatic", parent="world", child="carriage", xyz=[0, 0, 0.5], axis=[1, 0, 0], limits=[-2, 2])
ARM = dict(RAIL, name="arm", type="revolute", parent="carriage", child="hand", xyz=[0, 0, 0], axis=[0, 0, 1], limits=[-3, 3])
CRANE = json.dumps({
    "robot": {"name": "crane", "base": "world", "joints": [RAIL, ARM], "self_collision_link_pairs": [["world", "hand"]], "spheres": [
        {"link": "world", "center": [0, 1.5, 0.5], "radius": 0.1}, {"link": "hand", "center": [0, 0.5, 0], "radius": 0.02}]},
    "problems": [{"id": f"{scene}/{k}", "scene": scene, "start": [-1, 0], "goals": [[5, 5], [1, 0]], "obstacles": solids, "valid": True}
                 for scene, solids in SCENES.items() for k in range(6)]})
ROUND, EDGE = [[-1, 0], [-1, 3], [1, 3], [1, 0]], {"step": 0.5, "clearance": 0.1, "t": 0.5}
PATHS = [[[-1, 0], [1, 0]], ROUND, [[-0.9, 0], [1, 0]], [[-1, 0], [1, 0.1]], [[-1, 0], [0, 3.01], [1, 0]], {"ok": False}] + [
    {"path": ROUND} | more for more in (
        {"cost": 7.9}, {"cost": 8, "certificate": [EDGE] * 3}, {"certificate": [EDGE] * 2}, {"certificate": [dict(EDGE, step=2.1)] * 3},
        {"certificate": [dict(EDGE, pair=["hand", "pillar"])] * 3}, {"tilt": {"limit": 1, "largest": 0.1, "tool": [0, 0, 1], "world": [0, 0, 1]}})]
SMALL = """<mujoco model="small"><compiler angle="degree"/><option integrator="implicitfast"/><default>
<position kp="300" kv="20" forcerange="-50 50" ctrlrange="-2.1 2.1"/></default><worldbody><body name="base">
<geom type="box" size="0.05 0.05 0.05" pos="0 0 -0.1"/><body name="one" euler="0 0 90"><joint name="turn" axis="0 0 1" range="-170 170"/>
<geom type="capsule" fromto="0 0 0.02 0 0 0.2" size="0.02"/><body name="two" pos="0 0 0.25"><joint name="lift" axis="0 1 0" range="-120 120"/>
<geom type="capsule" fromto="0 0 0.03 0 0 0.2" size="0.02"/><body name="three" pos="0 0 0.25"><joint name="bend" axis="0 1 0" range="-120 120"/>
<geom type="capsule" fromto="0 0 0.03 0 0 0.1" size="0.015"/><site name="tcp" pos="0 0 0.15"/></body></body></body></body></worldbody><actuator>
<position name="turn" joint="turn"/><position name="lift" joint="lift"/><position name="bend" joint="bend"/></actuator>
<keyframe><key name="home" qpos="0 0.4 0.8" ctrl="0 0.4 0.8"/></keyframe></mujoco>
"""
LINK = '<link name="{}"><collision><geometry><mesh filename="cube.obj"/></geometry></collision></link>'
JOINT = ('<joint name="{0}" type="{0}"><parent link="{1}"/><child link="{2}"/><origin xyz="0.2 0 0.1"/><axis xyz="0 0 1"/>'
         '<limit lower="-1" upper="1" velocity="2" effort="50"/></joint>')
FILES = {  # text, bytes, or a path that is linked to; a file stands before those that it names
    "q.jsonl": json_lines({"q": q} for q in rows(40, 6, 3, 6)), "crane.json": CRANE, "crane.json.gz": gzip.compress(CRANE.encode(), mtime=0),
    "crane_paths.json": json.dumps({f"{('plate', 'pillar')[k // 6]}/{k % 6}": path for k, path in enumerate(PATHS)}),
    "poses.jsonl": json_lines({"pos": p, "quat": ([0, 1, 0, 0], [0.5, 0.5, -0.5, 0.5], [0.6, 0, 0.8, 0])[k % 3]} for k, p in enumerate(rows(40, 3, 1, 0.7))),
    "paths.jsonl": json_lines([
        {"type": "poses", "poses": NEAR[:3]}, {"type": "line", "from": NEAR[0], "to": NEAR[1], "speed": 0.5},
        {"type": "polyline", "points": NEAR[:3], "blend": 0.02}, {"type": "line", "from": NEAR[0], "to": NEAR[3], "max_step": 0.2},
        {"type": "arc", "from": NEAR[0], "via": NEAR[1], "to": NEAR[2], "orientation_tol": 0.2},
        {"type": "ellipse", "center": [0, -0.3, 0.5], "a": 0.3, "b": 0.15, "normal": [0, 0, 1], "quat": [0, 1, 0, 0]}]),
    "cases.json": json.dumps({"limits": {"v": [3.1] * 6, "a": [5] * 6, "j": [100] * 6}, "cases": [
        {"id": k, "q0": q[0], "q1": q[1], "v0": q[2], "waypoints": q} for k, q in enumerate(rows(6, 6, k, 1) for k in range(5))]}),
    "small.yaml": "robot: small.xml\nprogram:\n- movej: {joints: [0.5, 0.5, 0.5]}\n- wait: 100ms\n- plan: {joints: [-0.5, 0.3, 1]}\n",
    "all.yaml": "robot: panda\nposes: {a: {pos: [0.5, 0, 0.4], quat: [0, 1, 0, 0]}}\nprogram:\n- movej: a\n- grip: open\n- set: {tool: hand, zone: 1cm}\n"
                "- circle: {center: [0.5, 0, 0.5], radius: 5cm, normal: [0, 0, 1], quat: [0, 1, 0, 0]}\n- grip: close\n- plan: {joints: home}\n",
    "train.yaml": "task: {environments: 8}\nppo: {rollout_steps: 16, minibatch: 64, epochs: 2, actor: [8], critic: [8], total_steps: 512}\n"
                  "training: {evaluate_every: 256, evaluate_episodes: 4}\n",
    "rod.xml": '<mujoco><include file="universal_robots_ur5e/wall.xml"/><worldbody><body name="rod" pos="0.3 -0.45 0.06"><freejoint/>'
               '<geom name="rod" type="capsule" size="0.01 0.04"/></body></worldbody></mujoco>',
    "slide.xml": SMALL.replace('"bend" axis="0 1 0" range="-120 120"', '"bend" type="slide" axis="0 1 0" range="-1 1"'),
    "mesh.xml": SMALL.replace("<worldbody>", '<asset><mesh name="cube" file="cube.obj"/></asset><worldbody>').replace(
        'type="box" size="0.05 0.05 0.05"', 'type="mesh" mesh="cube"'),
    "rail.urdf": f'<robot name="r">{"".join(map(LINK.format, "abc"))}{JOINT.format("prismatic", "a", "b")}{JOINT.format("revolute", "b", "c")}</robot>',
    "cube.obj": "".join(f"v {x} {y} {z}\n" for x in (0, 0.05) for y in (0, 0.05) for z in (0, 0.05)) +
                "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n", "small.xml": SMALL,
    "crane_set/mbm_panda_public.json": CRANE, "crane_set/mbm_ur5_public.json": CRANE,
    # Stands for a Python with other libraries: keeps what it is asked; one of its answers is for `bench ik` alone.
    "venv/bin/python": '#!/bin/sh\ncat "$2" >>asked.json\n[ "$(basename "$1")" = ik.py ] && echo \'{"who": "peer", "version": "1", "set": '
                       '"reachable", "us": [1, 2], "q": [[0, 0, 0, 0, 0, 0]]}\' >>"$3"\necho \'{"who": "other", "error": "is missing"}\' >>"$3"\n'}


def expanded():
    """(name, line) of every case."""
    for line in re.sub(r"\n ", " ", CASES).split("\n"):
        while line != (line := re.sub(r"@([a-z]\w*)", lambda found: ALIASES[found[1]], line)):
            pass
        parts = re.split(r"\(([^()]*\|[^()]*)\)", line)
        for words in itertools.product(*([word.strip() for word in part.split("|")] for part in parts[1::2])):
            case = "".join(itertools.chain(*itertools.zip_longest(parts[::2], words, fillvalue=""))).replace("@1", "".join(words[:1]))
            if case:
                yield f"{re.sub(r'[^a-zA-Z0-9.=,-]+', '_', case)[:80]}-{zlib.crc32(case.encode()):08x}", case


def files_in(folder):
    """{path: content} but for links, which go to what was given."""
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in sorted(folder.rglob("*"))
            if path.is_file() and not path.is_symlink()}


def prepare(line, folder):
    """Writes what the line names, and what that names in turn."""
    for name, content in FILES.items():
        if re.search(rf"(?<![\w.-]){re.escape(name.split('/')[0])}(?![\w.-])", line):
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            if isinstance(content, pathlib.Path):
                path.symlink_to(content)
                continue
            path.write_bytes(content if isinstance(content, bytes) else content.encode())
            path.chmod(0o755)
            line += content if isinstance(content, str) else ""


def run_case(name, line, out, program, share):
    """Runs one line in a folder of its own and keeps what comes of it."""
    folder = out / name
    shutil.rmtree(folder, ignore_errors=True)
    for part in ("work", "home", "tmp"):
        (folder / part).mkdir(parents=True)
    prepare(line, folder / "work")
    # The language is fixed, nothing is fetched, and no cache of an earlier run is there.
    environment = {"PATH": f"{program.parent}:{os.environ['PATH']}", "SHARE": str(share), "LANG": "C.UTF-8", "HOME": f"{folder}/home",
                   "XDG_DATA_HOME": f"{folder}/home/data", "TMPDIR": f"{folder}/tmp", "MESA_SHADER_CACHE_DISABLE": "true",
                   "MENAGERIE_BASE_URL": "http://127.0.0.1:1/", "PIP_INDEX_URL": "http://127.0.0.1:1/"}
    with open(folder / "stdout", "wb") as stdout, open(folder / "stderr", "wb") as stderr:
        process = subprocess.Popen(["/bin/sh", "-c", MANY + line], cwd=folder / "work", env=environment, stdin=subprocess.DEVNULL,
                                   stdout=stdout, stderr=stderr, start_new_session=True)
        try:
            code = process.wait(SECONDS)
        except subprocess.TimeoutExpired:
            os.killpg(process.pid, signal.SIGKILL)
            code = f"ended after {SECONDS} s"
    shutil.rmtree(folder / "tmp")
    (folder / "code").write_text(f"{code}\n")
    (folder / "command").write_text(f"{line}\n")
    # Where it ran and where the program and MuJoCo stand is no answer, nor a process's number, nor the seconds that `train --no-timing` tables.
    for path, content in files_in(folder).items():
        plain = content.replace(bytes(folder), b"CASE").replace(bytes(share), b"SHARE").replace(bytes(program.parent), b"BIN")
        plain = re.sub(rb"/[^\s\":]*(?=/libmujoco)", b"MUJOCO", re.sub(rb"mjarm_bench_\d+", b"mjarm_bench_N", plain))
        plain = re.sub(rb"(?m)^(\| \d+ +\| \d+ +\|) +\d+\.\d +\|", rb"\1 T |", plain)
        if plain != content:
            (folder / path).write_bytes(plain)


def run(options):
    """Runs all that is asked for."""
    program, out, begin = options.mjarm.resolve(), options.out.resolve(), time.monotonic()
    share = program.parent.parent / "share/mjarm"
    if program.name != "mjarm" or not share.is_dir():
        sys.exit(f"{program}: expected the program mjarm, with ../share/mjarm beside its folder")
    if not options.only and out.exists() and any(out.iterdir()):
        sys.exit(f"{out}: is not empty")
    ALIASES["models"] = "|".join(sorted(str(file.relative_to(share / "models")) for file in share.glob("models/*/*.[xu]*")))
    ALIASES["programs"] = "|".join(sorted(file.stem for file in share.glob("programs/*.yaml")))
    policies = pathlib.Path(__file__).resolve().parent.parent.glob("mjarm/**/testdata/sb3_*.zip")
    FILES.update({file.name: file for file in policies})
    if options.data:
        FILES.update({word: options.data.resolve() / folder for word, folder in DATA.items()})
    cases = [(name, line) for name, line in expanded()
             if re.search(options.only, line) and (options.data or not re.search("|".join(DATA), line))]
    with concurrent.futures.ThreadPoolExecutor(options.jobs) as pool:
        list(pool.map(lambda case: run_case(*case, out, program, share), cases))
    print(f"{len(cases)} cases in {time.monotonic() - begin:.0f} s")


def compare(options):
    """Prints where files differ first; ends with exit code 1 where some do."""
    names, differ = sorted({path.name for folder in options.folders for path in folder.iterdir()}), 0
    for name in names:
        both = [files_in(folder / name) for folder in options.folders]
        faults = [f"{name}: not in {folder}" for folder, files in zip(options.folders, both) if not files]
        for path in sorted(both[0] | both[1]) if not faults else ():
            a, b = (files.get(path, b"(no such file)") for files in both)
            if a != b:
                at = next((i for i, (x, y) in enumerate(zip(a, b)) if x != y), min(len(a), len(b)))
                begin, line = max(a.rfind(b"\n", 0, at) + 1, at - 30), a.count(b"\n", 0, at) + 1
                faults.append(f"{name}/{path}:{line}: byte {at}: {a[begin:at + 50]!r} | {b[begin:at + 50]!r}")
        print("".join(f"{fault}\n" for fault in faults), end="")
        differ += bool(faults)
    print(f"{len(names)} cases, {differ} differ")
    sys.exit(1 if differ else 0)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    commands = parser.add_subparsers(required=True, metavar="run|compare")
    running = commands.add_parser("run", help="run the cases and keep what they answer")
    running.set_defaults(call=run)
    running.add_argument("--mjarm", type=pathlib.Path, required=True, metavar="PROGRAM", help="build/PRESET/bin/mjarm")
    running.add_argument("--out", type=pathlib.Path, required=True, metavar="DIR", help="folder that is filled")
    running.add_argument("--data", type=pathlib.Path, metavar="FOLDER", help="public data; without it fewer cases are run")
    running.add_argument("--only", default="", metavar="REGEX", help="only lines in which this is found")
    running.add_argument("--jobs", type=int, default=1, metavar="N", help="cases at once")
    comparing = commands.add_parser("compare", help="compare what two runs kept")
    comparing.set_defaults(call=compare)
    comparing.add_argument("folders", type=pathlib.Path, nargs=2, metavar="DIR")
    options = parser.parse_args()
    options.call(options)


if __name__ == "__main__":
    main()
