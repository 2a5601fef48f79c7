// search_test.js SITE: whether the search of a built site has the right page among its first three, for words that people
// use. Prints `ok NAME` or `not ok NAME` for each. Its code and its index are those of the page.
const fs = require("fs");
const vm = require("vm");

const EXPECTED = [
  ["docker", "docs/install"], ["podman", "docs/install"], ["conda", "docs/install"], ["ROS2", "docs/install"],
  ["pip", "docs/python"], ["wheel", "docs/python"], ["gym", "docs/python"], ["PPO", "docs/python"], ["GPU", "docs/python"],
  ["STL", "docs/tutorials/own_mesh"], ["mesh", "docs/gallery"],
  ["contact", "docs/interfaces"], ["contact points", "docs/interfaces"], ["force", "docs/interfaces"],
  ["wrench", "docs/interfaces"], ["measured_cf", "docs/interfaces"], ["events", "docs/interfaces"],
  ["lockstep", "docs/interfaces"], ["lock-step", "docs/gallery"], ["step service", "docs/interfaces"],
  ["breathing", "docs/scenes"], ["stiffness", "docs/scenes"], ["density", "docs/computation"], ["thickness", "docs/scenes"],
  ["friction", "docs/scenes"], ["pressure", "docs/scenes"], ["yeoh", "docs/computation"],
  ["replay", "docs/tutorials/record_and_replay"], ["rosbag", "docs/tutorials/record_and_replay"],
  ["snapshot", "docs/tutorials/record_and_replay"], ["report", "docs/sessions"], ["MCAP", "docs/export"], ["LeRobot", "docs/export"],
  ["CSV", "docs/export"], ["Foxglove", "docs/export"], ["ros1_bridge", "docs/export"], ["headset", "docs/web"], ["phone", "docs/web"],
  ["gamepad", "docs/tutorials/drive_by_hand"], ["latency", "docs/latency"], ["depth image", "docs/ground_truth"],
  ["import", "docs/import"], ["CSV motion", "docs/import"], ["baselines", "docs/data_set"], ["stereo", "docs/endoscope_camera"], ["cluster", "docs/cohorts"], ["licence", "README"],
  ["cite", "README"], ["parameters of nodes", "reference/parameters"], ["insuflator", "docs/scenes"],
];

const context = vm.createContext({});
for (const name of ["lunr.min.js", "sections.js", "search.js"])
  vm.runInContext(fs.readFileSync(`${process.argv[2]}/_static/${name}`, "utf8"), context, { filename: name });
const find = vm.runInContext("find", context);

function check(name, holds, seen) {
  console.log(holds ? `ok ${name}` : `not ok ${name}\n    ${seen}`);
}

for (const [words, page] of EXPECTED) {
  const first = find(words).slice(0, 3).map((found) => found.page);
  check(`search: '${words}' finds ${page}`, first.includes(page), first.join(", ") || "nothing");
}
const all = new Set(vm.runInContext("sections", context).map((section) => section.page));
const kept = [...all].filter((page) => /^code\/|CHANGELOG/.test(page));
check("search: no sources and no changelogs", all.size > 50 && kept.length === 0, kept.join(", "));
check("search: nothing for a word that nobody has written", find("xylophone").length === 0, "pages were found");
