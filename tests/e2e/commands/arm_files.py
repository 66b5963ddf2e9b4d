# SPDX-License-Identifier: MIT
"""Device files of tests: an arm on USB, its simulated twin, and a chain."""
WIRED = """hapticd-device: 1
module: usb_hid
name: mine
mount: {position: [0, 0, 0.09]}
limits: {force: 2, passivity: true, workspace: 0.3, enable: {button: 0}}
parameters:
  usb: {id: "1209:0a0a"}
  device: {max_force: 5, continuous_force: 2, max_stiffness: 600, mass: 0.2}
  arm:
    kind: phantom
    lengths: [0.21, 0.17, 0.03, 0, 0]
    masses: [0.02, 0.025, 0, 0]
    max_torque: [0.6]
    limits: [[-1.2, 1.2], [-0.3, 0.9], [-1, 1]]
  calibration: {method: pose, pose: [0, 0, 0], instructions: "Hold every joint at its zero."}
  wire:
    exchange: stream
    rate: 1000
    watchdog: 0.02
    input:
      size: 12
      fields:
        - {is: counter, at: 0, type: u16}
        - {is: position, joint: 1, at: 2, type: i16, scale: 9.6e-5}
        - {is: position, joint: 2, at: 4, type: i16, scale: 9.6e-5}
        - {is: position, joint: 3, at: 6, type: i16, scale: 9.6e-5}
        - {is: button, button: 1, at: 8, type: u1}
        - {is: checksum, at: 10, type: u16, method: crc16-modbus, from: 0, to: 10}
    output:
      size: 10
      fields:
        - {is: torque, joint: 1, at: 0, type: i16, scale: 2.0e-5}
        - {is: torque, joint: 2, at: 2, type: i16, scale: 2.0e-5}
        - {is: torque, joint: 3, at: 4, type: i16, scale: 2.0e-5}
        - {is: enable, at: 6, type: u8}
        - {is: counter, at: 7, type: u8}
        - {is: checksum, at: 8, type: u16, method: crc16-modbus, from: 0, to: 8}
"""
TWIN = """hapticd-device: 1
module: simulated
name: twin
mount: {position: [0, 0, 0.09]}
limits: {force: 2}
parameters:
  arm:
    kind: phantom
    lengths: [0.21, 0.17, 0, 0, 0]
    masses: [0.03, 0, 0.05, 0]
hand: {script: press, radius: 0.05, rise: 0.003, rate: 1, center: [0, 0, -0.09]}
"""
CHAIN = WIRED.replace("""    kind: phantom
    lengths: [0.21, 0.17, 0.03, 0, 0]
    masses: [0.02, 0.025, 0, 0]
""", """    kind: chain
    dh:
      - [0, 1.5707963, 0, 0]
      - [0.22, 0, 0, 0]
      - [0.2, 0, 0, 0]
""").replace("workspace: 0.3, ", "").replace("position: [0, 0, 0.09]", "position: [-0.42, 0, 0.09]")
