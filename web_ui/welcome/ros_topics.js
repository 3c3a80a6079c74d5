// What a ROS node finds at a robot: its topics, and the command that drives it. Pure.

import { robotTopic } from "../state/names.js";

/** The speed that is sent: 10 cm per second straight on, ten times a second for two seconds. */
export const SPEED_M_S = 0.1;
export const RATE_HZ = 10;
export const TIMES = 20;

/** Topics that a robot listens to (docs/ros.md, "Subscribed topics of a robot"). */
const LISTENS = [
  ["cmd_vel", "geometry_msgs/msg/Twist"],
  ["led/body/top", "std_msgs/msg/ColorRGBA"],
  ["led/circle", "std_msgs/msg/Float32MultiArray"],
  ["sound/tone", "std_msgs/msg/Float32MultiArray"],
  ["pen/down", "std_msgs/msg/Bool"],
];
/** Folders and topics that a robot publishes and that a first node needs. */
const PUBLISHES = ["buttons", "ground", "imu", "odom", "proximity"];

/** @typedef {{ topic: string, type: string }} Topic */

/** The command for a terminal that sends the speed. @param {string} robot */
export function speedCommand(robot) {
  return (
    `ros2 topic pub --rate ${RATE_HZ} --times ${TIMES} ${robotTopic(robot, "cmd_vel")} ` +
    `geometry_msgs/msg/Twist "{linear: {x: ${SPEED_M_S}}}"`
  );
}

/** What a robot listens to, its speed first. @param {string} robot @returns {Topic[]} */
export function listensTo(robot) {
  return LISTENS.map(([name, type]) => ({ topic: robotTopic(robot, name), type }));
}

/**
 * What a robot publishes; topics of one folder as one: `/ground/{left, right}`.
 *
 * @param {readonly string[]} topics  of the connection
 * @param {string} robot
 * @returns {string[]}
 */
export function publishesOf(topics, robot) {
  const start = robotTopic(robot, "");
  const own = topics
    .filter((topic) => topic.startsWith(start))
    .map((topic) => topic.slice(start.length).split("/"))
    .filter((words) => words.length <= 2 && PUBLISHES.includes(words[0]));
  return PUBLISHES.flatMap((name) => {
    const found = own.filter(([first]) => first === name);
    const leaves = found.flatMap(([, leaf]) => leaf ?? []);
    if (found.length === 0) return [];
    return [start + (leaves.length === 0 ? name : `${name}/{${leaves.sort().join(", ")}}`)];
  });
}
