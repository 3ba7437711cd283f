// All words of the page, in both languages side by side: [English, Chinese].

const WORDS = {
  // The bar at the top.
  transport: ['Simulation', '仿真'],
  pause: ['Pause', '暂停'],
  resume: ['Go on', '继续'],
  step: ['One step forward', '前进一步'],
  step_back: ['One step back', '后退一步'],
  reset: ['Reset', '重置'],
  speed: ['Speed', '速度'],
  faster: ['Faster', '加速'],
  slower: ['Slower', '减速'],
  time: ['Time', '时间'],
  paused: ['paused', '已暂停'],
  target: ['Target of the tool', '工具目标'],
  screenshot: ['Save a picture', '保存截图'],
  more: ['Settings', '设置'],
  help: ['Help', '帮助'],
  close: ['Close', '关闭'],
  hide_side: ['Panels on and off', '显示或隐藏面板'],

  // Leading an arm.
  lead_flat: ['Tool forth, back, left, right', '工具前后左右移动'],
  lead_high: ['Tool up, down, turning', '工具上下移动与转动'],
  lead_close: ['Close', '闭合'],
  lead_open: ['Open', '张开'],
  h_lead: ['lead the tool along x, y, z', '沿 x、y、z 移动工具'],
  h_lead_turn: ['turn it about x, y, z', '绕 x、y、z 转动'],
  h_lead_grip: ['close and open the gripper', '闭合和张开夹爪'],
  k_lead_turn: ['J L, arrows', 'J L、方向键'],
  help_lead: ['Leading the arm', '操纵机械臂'],

  // The scene.
  scene: ['The scene in 3D', '三维场景'],
  scene_hint: [
    'Shift and arrow keys turn the view, W A S D move it, PgUp and PgDn zoom; ? for help',
    'Shift 加方向键旋转视角，W A S D 平移，PgUp、PgDn 缩放；按 ? 查看帮助',
  ],
  view: ['View', '视角'],
  camera: ['Camera', '相机'],
  free_camera: ['Free view', '自由视角'],
  fit_long: ['Show all of the model', '显示整个模型'],
  front: ['Front', '正面'],
  side: ['Side', '侧面'],
  top: ['Top', '俯视'],
  first_view: ['First view', '最初视角'],
  collision: ['Collision shapes', '碰撞形状'],
  selected: ['Selected', '已选中'],
  body: ['Body', '物体'],
  geom: ['Geom', '几何体'],
  position: ['Position [m]', '位置 [m]'],
  quaternion: ['Quaternion', '四元数'],
  deselect: ['Deselect', '取消选中'],
  axis_view: ['Look along {0}', '沿 {0} 方向看'],
  status: ['Status', '状态'],

  // Panels.
  panels: ['Controls', '控制'],
  plots: ['Plots', '曲线图'],
  joints: ['Joints', '关节'],
  joint_value: ['{0}, value', '{0}，数值'],
  no_plots: ['No plots are on.', '没有打开的曲线图。'],
  sheet: ['Size of the panel', '面板大小'],
  plot_height: ['Height of the plots', '曲线图高度'],
  recording: ['Recording', '回放'],
  postures: ['All postures', '所有构型'],
  go: ['Go', '前往'],
  of_end: ['{0} of {1} s', '{0} / {1} s'],

  // Settings.
  theme: ['Appearance', '外观'],
  theme_auto: ['As the system', '跟随系统'],
  theme_light: ['Light', '浅色'],
  theme_dark: ['Dark', '深色'],
  language: ['Language', '语言'],
  shadows: ['Shadows', '阴影'],
  grid: ['Grid on the floor', '地面网格'],
  labels: ['Labels', '标签'],
  groups: ['Groups of shapes', '形状分组'],
  group: ['Group {0}', '第 {0} 组'],

  // Notices.
  connecting: ['Connecting…', '正在连接……'],
  loading_meshes: ['Loading shapes: {0} of {1}', '正在加载形状：{0} / {1}'],
  lost: ['Connection lost', '连接已断开'],
  lost_more: [
    'The last picture stays. The page tries to connect again.',
    '画面停留在最后一帧，正在尝试重新连接。',
  ],
  retry: ['Try now', '立即重试'],
  over: ['The run is over', '运行已结束'],
  over_more: ['The last picture stays.', '画面停留在最后一帧。'],
  refused: ['Refused: {0}', '被拒绝：{0}'],
  read_only: ['This page only shows; it cannot control.', '本页只能观看，不能操作。'],
  saved: ['Saved: {0}', '已保存：{0}'],
  not_saved: ['The picture could not be made.', '截图失败。'],
  no_webgl: ['No WebGL 2', '无法使用 WebGL 2'],
  no_webgl_more: [
    'This browser draws no 3D. Turn on hardware acceleration, or take another browser.',
    '此浏览器不能绘制三维画面。请开启硬件加速，或换用其他浏览器。',
  ],
  no_mesh: ['{0} shapes could not be loaded.', '有 {0} 个形状未能加载。'],
  wrong_protocol: ['Page and server are of different versions', '页面与服务器版本不一致'],
  wrong_protocol_more: ['Load the page anew.', '请重新加载页面。'],
  quality_low: ['Drawing is slow here: shadows are off.', '绘制较慢，已关闭阴影。'],

  // Help.
  help_title: ['Mouse, touch and keys', '鼠标、触摸和按键'],
  help_mouse: ['Mouse', '鼠标'],
  help_touch: ['Touch', '触摸'],
  help_keys: ['Keys', '按键'],
  k_left_drag: ['Left drag', '左键拖动'],
  k_right_drag: ['Right or middle drag', '右键或中键拖动'],
  k_wheel: ['Wheel', '滚轮'],
  k_double: ['Double-click', '双击'],
  k_ctrl_drag: ['Ctrl and left drag', 'Ctrl + 左键拖动'],
  k_handle: ['Drag a handle', '拖动控制柄'],
  k_ghost: ['Click a ghost', '单击虚影'],
  k_one_finger: ['One finger', '单指拖动'],
  k_two_fingers: ['Two fingers', '双指'],
  k_double_tap: ['Double tap', '双击'],
  k_long_press: ['Long press, then drag', '长按后拖动'],
  k_space: ['Space', '空格'],
  k_arrows: ['← →', '← →'],
  k_plus: ['+ −', '+ −'],
  k_backspace: ['Backspace', '退格键'],
  k_shift_arrows: ['Shift and arrows', 'Shift + 方向键'],
  k_pages: ['PgUp PgDn', 'PgUp PgDn'],
  k_home: ['Home', 'Home'],
  h_turn: ['Turn the view', '旋转视角'],
  h_move: ['Move the view', '平移视角'],
  h_zoom: ['Zoom', '缩放'],
  h_move_zoom: ['Move the view and zoom', '平移视角并缩放'],
  h_select: ['Select a body; the sky deselects', '选中物体；双击空白处取消'],
  h_push: ['Pull a body by a spring', '用弹簧拉动物体'],
  h_target: ['Move the target of the tool', '移动工具目标'],
  h_ghost: ['Choose the posture it shows', '选择它所示的构型'],
  h_pause: ['Pause and go on', '暂停或继续'],
  h_step: ['One step back or forward', '后退或前进一步'],
  h_speed: ['Faster, slower', '加速、减速'],
  h_reset: ['Reset the simulation', '重置仿真'],
  h_target_key: ['Target of the tool on and off', '显示或隐藏工具目标'],
  h_first_view: ['First view', '最初视角'],
  h_presets: ['Front, side, top', '正面、侧面、俯视'],
  h_fit: ['Show all of the model', '显示整个模型'],
  h_cameras: ['Cameras of the model', '模型自带的相机'],
  h_collision: ['Collision shapes on and off', '显示或隐藏碰撞形状'],
  h_panels: ['Panels on and off', '显示或隐藏面板'],
  h_picture: ['Save a picture', '保存截图'],
  h_help: ['This help', '打开或关闭本帮助'],
  h_values: [
    'In a value: arrow keys change it by one step, with Shift by ten; Enter takes what is typed.',
    '在数值框中：方向键每次改变一步，按住 Shift 为十步；按回车键确认输入。',
  ],
};

const LANGUAGES = ['en', 'zh'];
const listeners = [];
let column = 0;

/** @returns {'en'|'zh'} */
export function language() {
  return LANGUAGES[column];
}

/** @param {string} tag  as "zh-CN"; what is not known is English */
export function setLanguage(tag) {
  column = String(tag).toLowerCase().startsWith('zh') ? 1 : 0;
  document.documentElement.lang = column ? 'zh-CN' : 'en';
  fill(document);
  for (const listener of listeners) listener();
}

/** @param {() => void} listener  called after each change of the language */
export function onLanguage(listener) {
  listeners.push(listener);
}

/** The words of `key`, with values for {0}, {1}. */
export function t(key, ...values) {
  const words = WORDS[key]?.[column] ?? key;
  return words.replace(/\{(\d)\}/g, (_, place) => String(values[Number(place)]));
}

/** Fills in what has `data-word` (text), `data-word-label` (name and tip). */
export function fill(root) {
  for (const node of root.querySelectorAll('[data-word]')) node.textContent = t(node.dataset.word);
  for (const node of root.querySelectorAll('[data-word-label]')) label(node, t(node.dataset.wordLabel));
}

/** Gives a control its name, for people who hear it and as a tip. */
export function label(node, text) {
  node.setAttribute('aria-label', text);
  if (node.tagName === 'BUTTON' || node.tagName === 'LABEL') node.title = text;
}
