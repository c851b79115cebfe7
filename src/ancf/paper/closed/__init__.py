"""Cases with a closed form: statics, vibration, rigid bodies."""
