# What the XV-15 does beside showing what is sent.
