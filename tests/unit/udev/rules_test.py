"""The shipped udev rules: what the device files say, never open to the world, and read by udev without complaint."""
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile
import unittest

ROOT = pathlib.Path(__file__).resolve().parents[3]
RULES = ROOT / "udev" / "70-hapticd.rules"


class Rules(unittest.TestCase):
    def test_are_generated_from_the_device_files(self):
        subprocess.run([sys.executable, ROOT / "udev" / "generate-rules", "--check"], check=True)

    def test_of_another_arm_are_printed(self):
        generate = [sys.executable, ROOT / "udev" / "generate-rules"]
        before = RULES.read_text()
        with tempfile.TemporaryDirectory() as folder:
            arm = pathlib.Path(folder) / "my-arm.yaml"
            arm.write_text('hapticd-device: 1\nmodule: usb_hid\nparameters:\n  usb: {id: "1209:0A0a"}\n')
            told = subprocess.run([*generate, arm], check=True, capture_output=True, text=True).stdout
            self.assertIn('ATTR{idVendor}=="1209", ATTR{idProduct}=="0a0a"', told)
            self.assertIn('KERNELS=="*:1209:0A0A.*"', told)
            arm.write_text("models: []\n")
            self.assertIn("expected a device file", subprocess.run([*generate, arm], capture_output=True, text=True).stderr)
        self.assertIn("usage", subprocess.run([*generate, "--help"], check=True, capture_output=True, text=True).stdout)
        self.assertEqual(RULES.read_text(), before)

    def test_never_open_a_device_to_the_world(self):
        modes = re.findall(r'MODE\s*:?=\s*"(\d+)"', RULES.read_text())
        self.assertTrue(modes)
        for mode in modes:
            self.assertEqual(int(mode, 8) & 0o007, 0, mode)

    def test_name_every_id_of_a_device_file(self):
        text = RULES.read_text().lower()
        for file in (ROOT / "config" / "devices").glob("*.yaml"):
            for vendor, product in re.findall(r'id:\s*"([0-9a-fA-F]{4}):([0-9a-fA-F]{4})"', file.read_text()):
                self.assertIn(f'attr{{idvendor}}=="{vendor.lower()}", attr{{idproduct}}=="{product.lower()}"', text)

    def test_are_understood_by_udev(self):
        verify = shutil.which("udevadm")
        if verify is None or "verify" not in subprocess.run([verify, "--help"], capture_output=True, text=True).stdout:
            self.skipTest("no udevadm with a verify command here (systemd 254 has it)")
        subprocess.run([verify, "verify", "--resolve-names=never", RULES], check=True)


if __name__ == "__main__":
    unittest.main()
