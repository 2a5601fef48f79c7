"""What arrives on topics."""

import threading
import time

import rospy

from .wait import PATIENCE, wait_until


class Recorder:
    """Everything that arrives on a topic since the last clear(), in order, with the time of arrival on `clock`."""

    clock = staticmethod(time.time)

    def __init__(self, topic, message_type):
        self._arrivals = []
        self._lock = threading.Lock()
        self.subscriber = rospy.Subscriber(topic, message_type, self.take, queue_size=None, tcp_nodelay=True)

    def take(self, message):
        """The callback of the topic."""
        now = self.clock()
        with self._lock:
            self._arrivals.append((now, message))

    @property
    def arrivals(self):
        """(time, message)."""
        with self._lock:
            return list(self._arrivals)

    @property
    def messages(self):
        return [message for _, message in self.arrivals]

    def newest(self):
        """The last message, or None."""
        with self._lock:
            return self._arrivals[-1][1] if self._arrivals else None

    def stamps(self):
        """Of the messages [ns]."""
        return [message.header.stamp.to_nsec() for message in self.messages]

    def clear(self):
        with self._lock:
            self._arrivals = []

    def waits_for(self, condition=lambda message: True, seconds=PATIENCE):
        """The first message for which it holds, or None."""
        found = []

        def look():
            found[:] = [message for message in self.messages if condition(message)][:1]
            return found

        return found[0] if wait_until(look, seconds) else None

    def is_connected(self):
        """Whether somebody publishes the topic."""
        return self.subscriber.get_num_connections() > 0

    def waits_for_connection(self, seconds=PATIENCE):
        return wait_until(self.is_connected, seconds)

    def disconnect(self):
        self.subscriber.unregister()
