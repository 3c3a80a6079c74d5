// Uses a robot by roslib, and prints what happens, one JSON object per line. BRIDGE_URL is the address of the bridge.
import { Param, Ros, Service, Topic } from "roslib";

const say = (what) => console.log("#" + JSON.stringify(what));
const asked = (ask) => new Promise((resolve, reject) => ask(resolve, reject));

const ros = new Ros();
ros.on("error", (error) => console.error(String(error?.message ?? error)));
await ros.connect(process.env.BRIDGE_URL);

say({ "topic type": await asked((done, failed) => ros.getTopicType("/odom", done, failed)) });
say({ "has node": (await asked((done, failed) => ros.getNodes(done, failed))).includes("/simulator") });
const playground = new Param({ ros, name: "/simulator:playground" });
say({ parameter: await asked((done, failed) => playground.get(done, failed)) });

const wheels = new Topic({ ros, name: "/cmd_vel", messageType: "geometry_msgs/Twist" });
const odometry = new Topic({ ros, name: "/odom", messageType: "nav_msgs/Odometry", throttle_rate: 20, compression: "cbor" });
const hasMoved = await new Promise((resolve) => {
  odometry.subscribe((message) => {
    wheels.publish({ linear: { x: 0.1 } });
    if (message.pose.pose.position.x > 0.02) resolve(message.pose.covariance.length === 36);
  });
});
say({ "has moved": hasMoved });
odometry.unsubscribe();
wheels.unadvertise();

const served = new Service({ ros, name: "/client/switch", serviceType: "std_srvs/SetBool" });
await served.advertise((request, response) => {
  response.success = request.data;
  response.message = "from the client";
  return true;
});
const other = new Service({ ros, name: "/client/switch", serviceType: "std_srvs/SetBool" });
say({ answer: await asked((done, failed) => other.callService({ data: true }, done, failed)) });
await asked((done) => other.callService({ flag: true }, done, (error) => done(say({ refused: String(error) }))));
await served.unadvertise();
ros.close();
