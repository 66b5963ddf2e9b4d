"""Pushes with 2 N until it is ended. Usage: pusher.py PACKAGE_FOLDER NAME RUNTIME_FOLDER ARM"""
import sys
import time

sys.path.insert(0, sys.argv[1])
import hapticd

client = hapticd.connect(sys.argv[2], folder=sys.argv[3])
push = client.push(sys.argv[4], lambda state: (0.0, 0.0, 2.0))
time.sleep(1000)
